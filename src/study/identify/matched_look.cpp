#include "study/identify/matched_look.h"

#include <algorithm>
#include <cmath>

#include "app/scenario/parts.h"
#include "app/scenario/read_scenario.h"
#include "core/statistics.h"
#include "study/identify/episode_simulation.h"
#include "study/stats/statistics.h"

namespace faba {
namespace {

constexpr int kIterations = 4;            // each one reduces the error several times
constexpr double kIsolation = 2.5;        // distance of an isolated cell to its neighbours, cell widths
constexpr std::size_t kMinIsolated = 5;   // isolated cells
constexpr double kInitialContrast = 0.4;  // positive for bright cells, negative for dark ones
constexpr double kFaintest = 0.02, kDarkest = 0.95, kBrightest = 10;
constexpr double kMinWidth = 0.8;  // px

/// Appearance of one cell.
struct CellLook {
  double mass = 0;     ///< integrated grey value relative to the background, grey px^2
  double size_px = 0;  ///< as in Spot
};

/// Median of the isolated cells, or of all cells when too few are isolated.
CellLook look_of(const std::vector<Spot>& spots, double isolation_px) {
  std::vector<double> mass, size, isolated_mass, isolated_size;
  for (const Spot& s : spots) {
    double nearest = isolation_px;
    for (const Spot& other : spots)
      if (&other != &s) nearest = std::min(nearest, norm(Vec2{other.x_px - s.x_px, other.y_px - s.y_px}));
    mass.push_back(s.mass);
    size.push_back(s.size_px);
    if (nearest >= isolation_px) {
      isolated_mass.push_back(s.mass);
      isolated_size.push_back(s.size_px);
    }
  }
  if (isolated_mass.size() >= kMinIsolated) return {median(isolated_mass), median(isolated_size)};
  if (mass.empty()) return {};
  return {median(mass), median(size)};
}

}  // namespace

void match_look(ResponseVideo& v, const GrayF& frame, Boundary boundary) {
  const bool bright = v.view.cells.polarity == Polarity::bright;
  const double isolation_px = kIsolation * v.view.cells.cell_px;
  const Detector detector = v.view.detector();
  const std::vector<Spot> spots = detector.find(frame);
  const CellLook target = look_of(spots, isolation_px);
  v.cell_px = v.view.cells.cell_px;
  v.contrast = bright ? kInitialContrast : -kInitialContrast;
  if (!(target.mass > 0)) return;
  Episode still{"", 0, {{0, v.view.frame_s, 0}}, {}};
  for (const Spot& s : spots) still.positions_image.push_back({s.x_px, s.y_px});
  EpisodeSettings settings;
  settings.boundary = boundary;
  settings.model.part = {{"type", "dipole"}};
  for (int i = 0; i < kIterations; ++i) {
    const Document d = episode_scenario(v, still, settings, exact_timing(still));
    const EpisodeObservation seen =
        simulate_episode(read_scenario(d, builtin_parts()), 1, {}, {0.0}, Look::video, v.ground);
    const CellLook current = look_of(detector.find(seen.frames.front()), isolation_px);
    if (!(current.mass > 0)) return;
    const double width_ratio = std::clamp(target.size_px / current.size_px, 0.5, 2.0),
                 mass_ratio = target.mass / current.mass;
    v.cell_px = std::max(kMinWidth, v.cell_px * width_ratio);
    // At the same contrast the integrated grey value grows with the square of the width.
    const double ratio = mass_ratio / (width_ratio * width_ratio);
    v.contrast = bright ? std::clamp(v.contrast * ratio, kFaintest, kBrightest)
                        : std::clamp(std::expm1(std::log1p(v.contrast) * ratio), -kDarkest, -kFaintest);
  }
}

}  // namespace faba
