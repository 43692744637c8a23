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

constexpr int kTimes = 4;           // each time brings it several times nearer
constexpr double kApart = 2.5;      // widths of a cell, from which on a cell stands alone
constexpr std::size_t kEnough = 5;  // of those
constexpr double kFirst = 0.4;      // contrast, either way
constexpr double kFaintest = 0.02, kDarkest = 0.95, kBrightest = 10;
constexpr double kThinnest = 0.8;  // px

/// What a picture shows of one cell.
struct CellLook {
  double mass = 0;     ///< taken from the light or added to it, grey px^2
  double size_px = 0;  ///< as Spot has it
};

/// In the middle of those that stand alone, or of all where next to none does.
CellLook look_of(const std::vector<Spot>& spots, double apart) {
  std::vector<double> mass, size, lone_mass, lone_size;
  for (const Spot& s : spots) {
    double nearest = apart;
    for (const Spot& other : spots)
      if (&other != &s) nearest = std::min(nearest, norm(Vec2{other.x_px - s.x_px, other.y_px - s.y_px}));
    mass.push_back(s.mass);
    size.push_back(s.size_px);
    if (nearest >= apart) {
      lone_mass.push_back(s.mass);
      lone_size.push_back(s.size_px);
    }
  }
  if (lone_mass.size() >= kEnough) return {median(lone_mass), median(lone_size)};
  if (mass.empty()) return {};
  return {median(mass), median(size)};
}

}  // namespace

void match_look(ResponseVideo& v, const GrayF& frame, Boundary boundary) {
  const bool bright = v.view.cells.polarity == Polarity::bright;
  const double apart = kApart * v.view.cells.cell_px;
  const Detector detector = v.view.detector();
  const std::vector<Spot> spots = detector.find(frame);
  const CellLook wanted = look_of(spots, apart);
  v.cell_px = v.view.cells.cell_px;
  v.contrast = bright ? kFirst : -kFirst;
  if (!(wanted.mass > 0)) return;
  Episode still{"", 0, {{0, v.view.frame_s, 0}}, {}};
  for (const Spot& s : spots) still.places_image.push_back({s.x_px, s.y_px});
  EpisodeSettings settings;
  settings.boundary = boundary;
  settings.model.part = {{"type", "dipole"}};
  for (int i = 0; i < kTimes; ++i) {
    const Document d = episode_scenario(v, still, settings, exact_timing(still));
    const SeenEpisode seen =
        simulate_episode(read_scenario(d, builtin_parts()), 1, 0, {0.0}, Look::video, v.ground);
    const CellLook now = look_of(detector.find(seen.frames.front()), apart);
    if (!(now.mass > 0)) return;
    const double wider = std::clamp(wanted.size_px / now.size_px, 0.5, 2.0), more = wanted.mass / now.mass;
    v.cell_px = std::max(kThinnest, v.cell_px * wider);
    // A wider cell takes more light with the same contrast.
    const double ratio = more / (wider * wider);
    v.contrast = bright ? std::clamp(v.contrast * ratio, kFaintest, kBrightest)
                        : std::clamp(std::expm1(std::log1p(v.contrast) * ratio), -kDarkest, -kFaintest);
  }
}

}  // namespace faba
