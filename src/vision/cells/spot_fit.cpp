#include "vision/cells/spot_fit.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <numbers>

#include "vision/cells/kernels/spot_window.h"

namespace faba {
namespace {

constexpr int kPasses = 3;     // the first without, the others with subtraction of neighbouring spots
constexpr int kMaxMoves = 12;  // maximum moves of the window per pass; each halves the error

// Eigenvalues of a symmetric matrix, larger first, and the direction of the first eigenvector.
struct Axes {
  double large = 0, small = 0, angle = 0;
};
Axes axes_of(const Mat2& m) {
  const double half = 0.5 * (m.xx + m.yy), half_difference = std::hypot(0.5 * (m.xx - m.yy), m.xy);
  return {half + half_difference, half - half_difference, 0.5 * std::atan2(2 * m.xy, m.xx - m.yy)};
}

// Covariance of the spot from the covariance under the window: the inverse variances add. The result is
// limited to between 1/4 and 16 times the variance of the window.
Mat2 without_window(const Mat2& under, double sd) {
  const Axes a = axes_of(under);
  const double w = 1 / (sd * sd);
  const auto deconvolved = [&](double v) {
    const double inverse = 1 / std::max(v, 1e-3 * sd * sd) - w;
    return inverse <= w / 16 ? 16 / w : std::max(0.25 / w, 1 / inverse);
  };
  const double large = deconvolved(a.large), small = deconvolved(a.small), c = std::cos(a.angle),
               s = std::sin(a.angle);
  return {large * c * c + small * s * s, (large - small) * c * s, large * s * s + small * c * c};
}

GaussianSpot converge(SpotWindow& window, const SpotSeed& seed, double sd) {
  GaussianSpot to;
  to.x = seed.col;
  to.y = seed.row;
  SpotMoments m;
  to.offset = window.offset(to.x, to.y);
  for (int i = 0; i < kMaxMoves; ++i) {
    m = window.moments(to.x, to.y, to.offset);
    if (!(m.mass > 0)) return to;
    // For a Gaussian of the same width as the window, the centroid under the window moves by half the offset.
    to.x += std::clamp(2 * m.x, -sd, sd);
    to.y += std::clamp(2 * m.y, -sd, sd);
    if (std::hypot(to.x - seed.col, to.y - seed.row) > window.max_shift()) return to;
    if (std::hypot(m.x, m.y) < 5e-4) break;
  }
  to.cov = without_window(m.cov, sd);
  const double window_fraction =
      2 * std::numbers::pi * std::sqrt(std::max(1e-12, m.cov.xx * m.cov.yy - m.cov.xy * m.cov.xy));
  to.amplitude = m.mass / std::max(window_fraction, 1e-3 * sd * sd);
  to.valid = true;
  return to;
}

Spot spot_of(const GaussianSpot& s, const SpotSeed& seed) {
  const Axes a = axes_of(s.cov);
  Spot spot;
  spot.x_px = s.x;
  spot.y_px = s.y;
  spot.snr = seed.snr;
  spot.mass = 2 * std::numbers::pi * std::sqrt(a.large * a.small) * s.amplitude;
  spot.size_px = kFwhmPerSd * std::sqrt(std::sqrt(a.large * a.small));
  spot.elongation = std::sqrt(a.large / a.small);
  spot.angle_rad = a.angle;
  spot.sd_px = std::sqrt(2 / std::numbers::pi) * seed.noise / s.amplitude;
  return spot;
}

// Neighbour search on a grid with cells of the window size.
class Neighbours {
 public:
  Neighbours(const std::vector<SpotSeed>& seeds, const GrayF& g, double reach)
      : cell_(std::max(1, int(std::ceil(reach)))),
        columns_(g.width / cell_ + 1),
        rows_(g.height / cell_ + 1) {
    lists_.resize(std::size_t(columns_) * std::size_t(rows_));
    for (std::size_t i = 0; i < seeds.size(); ++i)
      list(seeds[i].col / cell_, seeds[i].row / cell_).push_back(i);
  }
  template <class Visit>
  void each(const SpotSeed& s, std::size_t self, const Visit& visit) {
    for (int r = std::max(0, s.row / cell_ - 1); r <= std::min(rows_ - 1, s.row / cell_ + 1); ++r)
      for (int c = std::max(0, s.col / cell_ - 1); c <= std::min(columns_ - 1, s.col / cell_ + 1); ++c)
        for (const std::size_t i : list(c, r))
          if (i != self) visit(i);
  }

 private:
  std::vector<std::size_t>& list(int col, int row) {
    return lists_[std::size_t(row) * std::size_t(columns_) + std::size_t(col)];
  }
  int cell_, columns_, rows_;
  std::vector<std::vector<std::size_t>> lists_;
};

}  // namespace

std::vector<Spot> fit_spots(const GrayF& difference, const std::vector<SpotSeed>& seeds, double sd_px) {
  std::vector<GaussianSpot> shapes;
  shapes.reserve(seeds.size());
  for (const SpotSeed& seed : seeds)
    shapes.push_back({double(seed.col), double(seed.row), 0, 0, {sd_px * sd_px, 0, sd_px * sd_px}});
  SpotWindow window(sd_px);
  Neighbours near(seeds, difference, 10 * sd_px + 3);
  for (int pass = 0; pass < kPasses; ++pass) {
    std::vector<GaussianSpot> next = shapes;
    for (std::size_t i = 0; i < seeds.size(); ++i) {
      bool isolated = true;
      near.each(seeds[i], i, [&](std::size_t k) { isolated = isolated && !shapes[k].valid; });
      if (pass > 0 && isolated) continue;
      window.place(difference, seeds[i].col, seeds[i].row);
      near.each(seeds[i], i, [&](std::size_t k) {
        if (shapes[k].valid) window.subtract(shapes[k]);
      });
      next[i] = converge(window, seeds[i], sd_px);
    }
    shapes = std::move(next);
  }
  std::vector<Spot> spots;
  for (std::size_t i = 0; i < seeds.size(); ++i)
    if (shapes[i].valid) spots.push_back(spot_of(shapes[i], seeds[i]));
  return spots;
}

}  // namespace faba
