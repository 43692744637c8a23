#include "vision/drop/edge_profile.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <vector>

namespace faba {
namespace {

using Coefficients = std::array<double, 4>;

/// One shape with its linear coefficients {offset, slope, first, second} at a given position and width.
struct Trial {
  double position = 0, width = 1, residual = 1e300;
  Coefficients k{};
};

/// Model columns in addition to the straight line.
struct Columns {
  bool step, ring;
};

/// Solves the n x n normal equations in place by Cholesky; false when they are singular.
bool solve(std::array<Coefficients, 4>& a, Coefficients& b, std::size_t n) {
  for (std::size_t i = 0; i < n; ++i) {
    for (std::size_t j = 0; j <= i; ++j) {
      double sum = a[i][j];
      for (std::size_t k = 0; k < j; ++k) sum -= a[i][k] * a[j][k];
      if (i != j)
        a[i][j] = sum / a[j][j];
      else if (sum > 1e-12 * a[i][i] && sum > 0)
        a[i][i] = std::sqrt(sum);
      else
        return false;
    }
  }
  for (std::size_t i = 0; i < n; ++i) {
    for (std::size_t k = 0; k < i; ++k) b[i] -= a[i][k] * b[k];
    b[i] /= a[i][i];
  }
  for (std::size_t i = n; i-- > 0;) {
    for (std::size_t k = i + 1; k < n; ++k) b[i] -= a[k][i] * b[k];
    b[i] /= a[i][i];
  }
  return true;
}

Trial fit_at(std::span<const double> t, std::span<const double> grey, Columns columns, double position,
             double width) {
  Trial trial{position, width, 1e300, {}};
  const std::size_t n = columns.step && columns.ring ? 4 : 3;
  std::array<Coefficients, 4> a{};
  Coefficients b{};
  double squares = 0;
  for (std::size_t i = 0; i < t.size(); ++i) {
    const double u = (t[i] - position) / width;
    const double step = columns.step ? 0.5 * std::erfc(-u * 0.70710678118654752) : 0;
    const double ring = columns.ring ? std::exp(-0.5 * u * u) : 0;
    const Coefficients x{1, t[i], columns.step ? step : ring, ring};
    for (std::size_t r = 0; r < n; ++r) {
      for (std::size_t c = 0; c <= r; ++c) a[r][c] += x[r] * x[c];
      b[r] += x[r] * grey[i];
    }
    squares += grey[i] * grey[i];
  }
  Coefficients k = b;
  if (!solve(a, k, n)) return trial;
  trial.residual = squares;
  for (std::size_t r = 0; r < n; ++r) trial.residual -= k[r] * b[r];
  trial.k = k;
  return trial;
}

Trial fit_shape(std::span<const double> t, std::span<const double> grey, Columns columns) {
  const double pitch = t[1] - t[0], reach = 0.5 * (t.back() - t.front()) / 2;
  Trial best;
  auto consider = [&](double position, double width) {
    const Trial trial = fit_at(t, grey, columns, position, width);
    if (trial.residual < best.residual) best = trial;
  };
  double width = pitch;
  while (width < reach / 1.4) {
    const double mesh = std::max(pitch, width / 1.5);
    const int steps = int(2 * reach / mesh);
    for (int i = 0; i <= steps; ++i) consider(-reach + i * mesh, width);
    width *= 1.8;
  }
  // Each round halves the search mesh around the best point.
  double dp = std::max(pitch, best.width / 1.5), dw = 1.8;
  for (int round = 0; round < 9; ++round) {
    dp /= 2;
    dw = std::sqrt(dw);
    const Trial middle = best;
    for (int i = -1; i <= 1; ++i)
      for (int j = -1; j <= 1; ++j)
        if (i || j) consider(middle.position + i * dp, std::max(middle.width * std::pow(dw, j), 0.8 * pitch));
  }
  return best;
}

/// Residual sum of squares of the linear fit.
double line_residual(std::span<const double> t, std::span<const double> grey) {
  std::array<Coefficients, 4> a{};
  Coefficients b{};
  double squares = 0;
  for (std::size_t i = 0; i < t.size(); ++i) {
    const Coefficients x{1, t[i], 0, 0};
    for (std::size_t r = 0; r < 2; ++r) {
      for (std::size_t c = 0; c <= r; ++c) a[r][c] += x[r] * x[c];
      b[r] += x[r] * grey[i];
    }
    squares += grey[i] * grey[i];
  }
  Coefficients k = b;
  if (!solve(a, k, 2)) return 0;
  return squares - k[0] * b[0] - k[1] * b[1];
}

}  // namespace

EdgeProfile fit_edge_profile(std::span<const double> grey) {
  std::vector<double> offset;
  const auto middle = double(std::size_t{grey.size() / 2});
  for (std::size_t i = 0; i < grey.size(); ++i) offset.push_back(double(i) - middle);
  // The mean is subtracted for numerical accuracy of the sums of squares.
  double mean = 0;
  for (double g : grey) mean += g / double(grey.size());
  std::vector<double> centred;
  for (double g : grey) centred.push_back(g - mean);
  const double all = line_residual(offset, centred);
  EdgeProfile out;
  if (!(all > 0)) return out;
  constexpr double kEnough = 0.99;  // fraction of the variance
  const Trial step = fit_shape(offset, centred, {true, false}),
              ring = fit_shape(offset, centred, {false, true});
  // A line whose sides differ by more than its height is the shoulder of a step.
  const double fall = std::fabs(ring.k[1]) * (offset.back() - offset.front());
  const bool is_ring = ring.residual < step.residual && fall < std::fabs(ring.k[2]);
  Trial best = is_ring ? ring : step;
  out.shape = is_ring ? EdgeShape::ring : EdgeShape::step;
  if (best.residual > (1 - kEnough) * all) {
    const Trial both = fit_shape(offset, centred, {true, true});
    // The line must be higher than the step; otherwise a detail beside the step would determine its position.
    if (both.residual < 0.5 * best.residual && std::fabs(both.k[3]) > std::fabs(both.k[2])) {
      best = both;
      out.shape = EdgeShape::step_ring;
    }
  }
  out.position = best.position;
  out.width = best.width;
  out.explained = std::clamp(1 - best.residual / all, 0.0, 1.0);
  if (out.shape != EdgeShape::ring) out.step = best.k[2];
  if (out.shape == EdgeShape::ring) out.ring = best.k[2];
  if (out.shape == EdgeShape::step_ring) out.ring = best.k[3];
  return out;
}

}  // namespace faba
