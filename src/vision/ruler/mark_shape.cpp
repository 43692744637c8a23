#include "vision/ruler/mark_shape.h"

#include <Eigen/Dense>
#include <algorithm>
#include <cmath>
#include <complex>
#include <numbers>
#include <utility>

namespace faba {
namespace {

constexpr int kShapeSteps = 480;       // number of steps of the tabulated shape
constexpr double kMinSlopedPitch = 6;  // px, minimum pitch for the fit of a slope

}  // namespace

MarkProfile::MarkProfile(double first, std::vector<double> grey, double pitch_px)
    : first_s(first), raw(std::move(grey)), flat(raw.size()) {
  // Cumulative sums of the finite values and of their number; fractional window ends, so that the window is
  // exactly two pitches.
  const int n = int(raw.size());
  std::vector<double> sum(raw.size() + 1, 0.0), count(raw.size() + 1, 0.0);
  for (std::size_t i = 0; i < raw.size(); ++i) {
    const bool valid = std::isfinite(raw[i]);
    sum[i + 1] = sum[i] + (valid ? raw[i] : 0);
    count[i + 1] = count[i] + (valid ? 1 : 0);
  }
  const auto cumulative = [n](const std::vector<double>& sums, double position) {
    const double p = std::clamp(position, 0.0, double(n));
    const int i = std::min(int(p), n - 1);
    return sums[std::size_t(i)] + (p - i) * (sums[std::size_t(i) + 1] - sums[std::size_t(i)]);
  };
  for (int i = 0; i < n; ++i) {
    const double from = i + 0.5 - pitch_px, to = i + 0.5 + pitch_px;
    flat[std::size_t(i)] =
        raw[std::size_t(i)] - (cumulative(sum, to) - cumulative(sum, from)) /
                                  std::max(0.5, cumulative(count, to) - cumulative(count, from));
  }
}

MarkShape::MarkShape(std::span<const MarkProfile> profiles, std::span<const std::vector<double>> at,
                     double pitch_px)
    : pitch_px_(pitch_px) {
  const std::size_t harmonics = std::size_t(std::clamp(int(pitch_px / 2.2), 1, 20));
  std::vector<double> cosines(harmonics, 0.0), sines(harmonics, 0.0);
  double count = 0;
  for (std::size_t strip = 0; strip < profiles.size(); ++strip) {
    const MarkProfile& y = profiles[strip];
    for (const double middle : at[strip]) {
      const int from = int(std::ceil(middle - pitch_px / 2 - y.first_s));
      const int to = int(std::ceil(middle + pitch_px / 2 - y.first_s));
      for (int i = std::max(0, from); i < std::min(to, int(y.flat.size())); ++i) {
        const double v = y.flat[std::size_t(i)];
        if (!std::isfinite(v)) continue;
        const std::complex<double> turn =
            std::polar(1.0, 2 * std::numbers::pi * (i + y.first_s - middle) / pitch_px);
        std::complex<double> wave = 1;
        for (std::size_t m = 0; m < harmonics; ++m) {
          wave *= turn;
          cosines[m] += 2 * v * wave.real();
          sines[m] += 2 * v * wave.imag();
        }
        ++count;
      }
    }
  }
  for (std::size_t m = 0; m < harmonics && count > 0; ++m) {
    cosines[m] /= count;
    sines[m] /= count;
  }
  tabulate(cosines, sines);
  describe();
}

void MarkShape::tabulate(std::span<const double> cosines, std::span<const double> sines) {
  const double unit = 2 * std::numbers::pi / pitch_px_;
  grey_.assign(kShapeSteps + 1, 0.0);
  slope_.assign(kShapeSteps + 1, 0.0);
  for (std::size_t i = 0; i <= kShapeSteps; ++i) {
    const std::complex<double> turn = std::polar(1.0, 2 * std::numbers::pi * double(i) / kShapeSteps);
    std::complex<double> wave = 1;
    for (std::size_t m = 0; m < cosines.size(); ++m) {
      wave *= turn;
      grey_[i] += cosines[m] * wave.real() + sines[m] * wave.imag();
      slope_[i] += double(m + 1) * unit * (sines[m] * wave.real() - cosines[m] * wave.imag());
    }
  }
}

double MarkShape::look_up(const std::vector<double>& table, double offset_px) const {
  const double turns = offset_px / pitch_px_, position = (turns - std::floor(turns)) * kShapeSteps;
  const std::size_t i = std::min(std::size_t(position), std::size_t(kShapeSteps - 1));
  const double part = position - double(i);
  return table[i] + part * (table[i + 1] - table[i]);
}

void MarkShape::describe() {
  const std::vector<double> v(grey_.begin(), grey_.end() - 1);
  const auto [low, high] = std::minmax_element(v.begin(), v.end());
  const double half = (*low + *high) / 2;
  range_ = *high - *low;
  const int below = int(std::count_if(v.begin(), v.end(), [half](double x) { return x < half; }));
  dark_ = 2 * below <= kShapeSteps;
  width_px_ = std::min(below, kShapeSteps - below) * pitch_px_ / kShapeSteps;
  // Centroid of the part beyond the half level, around the extremum.
  const int top = int((dark_ ? low : high) - v.begin());
  double weight = 0, moment = 0;
  for (int k = -kShapeSteps / 2; k < kShapeSteps / 2; ++k) {
    const double beyond = (v[std::size_t((top + k + kShapeSteps) % kShapeSteps)] - half) * (dark_ ? -1 : 1);
    if (beyond <= 0) continue;
    weight += beyond;
    moment += beyond * k;
  }
  const double centre = (top + (weight > 0 ? moment / weight : 0)) * pitch_px_ / kShapeSteps;
  centre_px_ = std::remainder(centre, pitch_px_);
}

namespace {

/// One iteration of the fit of level, slope, size and shift around `at`; fit() returns false when it is not
/// possible.
struct MarkFit {
  double size = 0, shift = 0;
  double slope = 0;  ///< slope of the background, grey over the interval
  double explained =
      0;  ///< fraction of the variance about the linear background that the shape without shift explains
  bool fit(const MarkProfile& y, double at, double pitch, const MarkShape& shape);
};

bool MarkFit::fit(const MarkProfile& y, double at, double pitch, const MarkShape& shape) {
  const double reach = std::max(pitch / 2, 2.5);
  const int from = int(std::ceil(at - reach - y.first_s)), to = int(std::floor(at + reach - y.first_s));
  if (from < 0 || to >= int(y.raw.size())) return false;
  // Slope and shift can be separated only when the shape has more than the first harmonic.
  const bool sloped = pitch >= kMinSlopedPitch;
  Eigen::Matrix4d normal = Eigen::Matrix4d::Zero();
  Eigen::Vector4d right = Eigen::Vector4d::Zero();
  double squares = 0;
  for (int i = from; i <= to; ++i) {
    const double v = y.raw[std::size_t(i)], offset = i + y.first_s - at;
    if (!std::isfinite(v)) return false;
    const Eigen::Vector4d x(1, sloped ? offset / reach : 0, shape.grey(offset), -shape.slope(offset));
    normal += x * x.transpose();
    right += v * x;
    squares += v * v;
  }
  if (!sloped) normal(1, 1) = 1;
  const Eigen::Vector4d k = normal.ldlt().solve(right);
  const Eigen::Vector2d ground = normal.topLeftCorner<2, 2>().ldlt().solve(Eigen::Vector2d(right.head<2>()));
  const Eigen::Vector3d unshifted =
      normal.topLeftCorner<3, 3>().ldlt().solve(Eigen::Vector3d(right.head<3>()));
  const double variance = squares - ground.dot(right.head<2>());
  if (!k.allFinite() || !unshifted.allFinite() || !(variance > 0) || k[2] == 0) return false;
  size = k[2];
  shift = k[3] / k[2];
  slope = 2 * k[1];
  explained = unshifted[2] > 0 ? 1 - (squares - unshifted.dot(right.head<3>())) / variance : 0;
  return true;
}

}  // namespace

MarkReading read_mark(const MarkProfile& y, double at, double pitch_px, const MarkShape& shape) {
  MarkReading reading;
  MarkFit f;
  if (!f.fit(y, at, pitch_px, shape) || !(f.size > 0.1)) return reading;
  const double first = std::clamp(f.shift, -0.25 * pitch_px, 0.25 * pitch_px);
  if (!f.fit(y, at + first, pitch_px, shape)) return reading;
  reading.size = f.size;
  reading.shift_px = first + f.shift;
  reading.found = f.size > 0.25 && f.size < 4 && std::fabs(f.shift) < 0.12 * pitch_px &&
                  std::fabs(reading.shift_px) < 0.3 * pitch_px && f.explained > 0.25 &&
                  std::fabs(f.slope) < 0.5 * f.size * shape.range();
  return reading;
}

}  // namespace faba
