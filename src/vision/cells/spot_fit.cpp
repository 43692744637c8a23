#include "vision/cells/spot_fit.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <numbers>

#include "core/statistics.h"

namespace faba {
namespace {

constexpr int kPasses = 3;     // the first without, the others with subtraction of neighbouring spots
constexpr int kMaxMoves = 12;  // maximum moves of the window per pass; each halves the error
constexpr double kRing = 3.5;  // sd, inner radius of the ring for the local offset; its width is 1.5 sd

// Gaussian model of a spot: amplitude and covariance.
struct Shape {
  double x = 0, y = 0, offset = 0, amplitude = 0;
  Mat2 cov;
  bool valid = false;

  double reach() const { return 3.5 * std::sqrt(std::max(cov.xx, cov.yy)); }
};

struct Moments {
  double mass = 0, x = 0, y = 0;
  Mat2 cov;
};

// Pixels of a window around a spot, with the light of other spots subtracted.
class Window {
 public:
  Window(const GrayF& g, const SpotSeed& seed, double sd)
      : sd_(sd),
        left_(std::max(0, seed.col - half(sd))),
        top_(std::max(0, seed.row - half(sd))),
        right_(std::min(g.width - 1, seed.col + half(sd))),
        bottom_(std::min(g.height - 1, seed.row + half(sd))) {
    px_.reserve(std::size_t(right_ - left_ + 1) * std::size_t(bottom_ - top_ + 1));
    for (int row = top_; row <= bottom_; ++row) {
      const float* first = &g.px[std::size_t(row) * std::size_t(g.width)];
      px_.insert(px_.end(), first + left_, first + right_ + 1);
    }
  }
  void subtract(const Shape& other) {
    const double r = other.reach();
    if (other.x < left_ - r || other.x > right_ + r || other.y < top_ - r || other.y > bottom_ + r) return;
    // Recursive evaluation of the Gaussian along a row: the ratio of neighbouring values changes by a
    // constant factor. Starts at the maximum, so that rounding errors are relative to it.
    const double det = other.cov.xx * other.cov.yy - other.cov.xy * other.cov.xy;
    const double xx = other.cov.yy / det, xy = -other.cov.xy / det, yy = other.cov.xx / det,
                 curvature = std::exp(-xx);
    for (int row = top_; row <= bottom_; ++row) {
      double* const px = &px_[std::size_t(row - top_) * std::size_t(right_ - left_ + 1)];
      const double dy = row - other.y, peak = other.x - xy / xx * dy;
      const int from = int(std::clamp(std::round(peak), double(left_), double(right_)));
      const double dx = from - other.x;
      const double middle =
          other.amplitude * std::exp(-0.5 * (xx * dx * dx + 2 * xy * dx * dy + yy * dy * dy));
      const double slope = xx * dx + xy * dy;
      double value = middle, step = std::exp(-slope - 0.5 * xx);
      for (int col = from; col <= right_; ++col, value *= step, step *= curvature) px[col - left_] -= value;
      step = std::exp(slope - 0.5 * xx);
      value = middle * step;
      step *= curvature;
      for (int col = from - 1; col >= left_; --col, value *= step, step *= curvature)
        px[col - left_] -= value;
    }
  }
  // Local offset: median of a ring around the spot.
  double offset(double x, double y) const {
    const double in = kRing * sd_, out = in + std::max(1.5 * sd_, 1.5);
    std::vector<double> ring;
    std::size_t i = 0;
    for (int row = top_; row <= bottom_; ++row)
      for (int col = left_; col <= right_; ++col, ++i) {
        const double r2 = (col - x) * (col - x) + (row - y) * (row - y);
        if (r2 >= in * in && r2 <= out * out) ring.push_back(px_[i]);
      }
    return ring.empty() ? 0 : median_high(ring);
  }
  Moments moments(double x, double y, double offset) {
    Moments m;
    const double k = -0.5 / (sd_ * sd_), reach = 3 * sd_ + 0.5;
    const int first = std::max(left_, int(x - reach)), last = std::min(right_, int(x + reach + 1));
    across_.clear();
    for (int col = first; col <= last; ++col) across_.push_back(std::exp(k * (col - x) * (col - x)));
    for (int row = std::max(top_, int(y - reach)); row <= std::min(bottom_, int(y + reach + 1)); ++row) {
      const double dy = row - y, down = std::exp(k * dy * dy);
      for (int col = first; col <= last; ++col) {
        const double dx = col - x;
        const double v =
            px_[std::size_t(row - top_) * std::size_t(right_ - left_ + 1) + std::size_t(col - left_)];
        const double w = down * across_[std::size_t(col - first)] * (v - offset);
        m.mass += w;
        m.x += w * dx;
        m.y += w * dy;
        m.cov.xx += w * dx * dx;
        m.cov.xy += w * dx * dy;
        m.cov.yy += w * dy * dy;
      }
    }
    if (m.mass <= 0) return m;
    m.x /= m.mass;
    m.y /= m.mass;
    m.cov = {m.cov.xx / m.mass - m.x * m.x, m.cov.xy / m.mass - m.x * m.y, m.cov.yy / m.mass - m.y * m.y};
    return m;
  }

 private:
  static int half(double sd) { return int(std::ceil(kRing * sd + std::max(1.5 * sd, 1.5) + 1.5 * sd)) + 1; }
  double sd_;
  int left_, top_, right_, bottom_;
  std::vector<double> px_, across_;
};

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

Shape converge(Window& window, const SpotSeed& seed, Shape from, double sd) {
  Shape to = from;
  to.valid = false;
  Moments m;
  to.offset = window.offset(to.x, to.y);
  for (int i = 0; i < kMaxMoves; ++i) {
    m = window.moments(to.x, to.y, to.offset);
    if (!(m.mass > 0)) return to;
    // For a Gaussian of the same width as the window, the centroid under the window moves by half the offset.
    to.x += std::clamp(2 * m.x, -sd, sd);
    to.y += std::clamp(2 * m.y, -sd, sd);
    if (std::hypot(to.x - seed.col, to.y - seed.row) > std::max(1.5, 1.5 * sd)) return to;
    if (std::hypot(m.x, m.y) < 5e-4) break;
  }
  to.cov = without_window(m.cov, sd);
  const double window_fraction =
      2 * std::numbers::pi * std::sqrt(std::max(1e-12, m.cov.xx * m.cov.yy - m.cov.xy * m.cov.xy));
  to.amplitude = m.mass / std::max(window_fraction, 1e-3 * sd * sd);
  to.valid = true;
  return to;
}

Spot spot_of(const Shape& s, const SpotSeed& seed) {
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
  std::vector<Shape> shapes;
  shapes.reserve(seeds.size());
  for (const SpotSeed& seed : seeds)
    shapes.push_back({double(seed.col), double(seed.row), 0, 0, {sd_px * sd_px, 0, sd_px * sd_px}});
  Neighbours near(seeds, difference, 10 * sd_px + 3);
  for (int pass = 0; pass < kPasses; ++pass) {
    std::vector<Shape> next = shapes;
    for (std::size_t i = 0; i < seeds.size(); ++i) {
      bool isolated = true;
      near.each(seeds[i], i, [&](std::size_t k) { isolated = isolated && !shapes[k].valid; });
      if (pass > 0 && isolated) continue;
      Window window(difference, seeds[i], sd_px);
      near.each(seeds[i], i, [&](std::size_t k) {
        if (shapes[k].valid) window.subtract(shapes[k]);
      });
      next[i] = converge(window, seeds[i], {double(seeds[i].col), double(seeds[i].row), 0, 0, {}}, sd_px);
    }
    shapes = std::move(next);
  }
  std::vector<Spot> spots;
  for (std::size_t i = 0; i < seeds.size(); ++i)
    if (shapes[i].valid) spots.push_back(spot_of(shapes[i], seeds[i]));
  return spots;
}

}  // namespace faba
