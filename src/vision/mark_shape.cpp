#include "vision/mark_shape.h"

#include <Eigen/Dense>
#include <algorithm>
#include <cmath>
#include <complex>
#include <numbers>

namespace faba {
namespace {

constexpr int kSteps = 480;  // of a tabulated shape

}  // namespace

MarkProfile::MarkProfile(double first, const std::vector<double>& raw, double pitch_px) : first_s(first) {
  // Sums of what is there and how much it is; the ends of the window count in part, so that it is two
  // pitches exactly.
  const int n = int(raw.size());
  std::vector<double> sum(raw.size() + 1, 0.0), count(raw.size() + 1, 0.0);
  for (std::size_t i = 0; i < raw.size(); ++i) {
    const bool there = std::isfinite(raw[i]);
    sum[i + 1] = sum[i] + (there ? raw[i] : 0);
    count[i + 1] = count[i] + (there ? 1 : 0);
  }
  const auto upto = [n](const std::vector<double>& sums, double place) {
    const double p = std::clamp(place, 0.0, double(n));
    const int i = std::min(int(p), n - 1);
    return sums[std::size_t(i)] + (p - i) * (sums[std::size_t(i) + 1] - sums[std::size_t(i)]);
  };
  grey.resize(raw.size());
  for (int i = 0; i < n; ++i) {
    const double from = i + 0.5 - pitch_px, to = i + 0.5 + pitch_px;
    grey[std::size_t(i)] =
        raw[std::size_t(i)] - (upto(sum, to) - upto(sum, from)) / std::max(0.5, upto(count, to) - upto(count, from));
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
      for (int i = std::max(0, from); i < std::min(to, int(y.grey.size())); ++i) {
        const double v = y.grey[std::size_t(i)];
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
  grey_.assign(kSteps + 1, 0.0);
  slope_.assign(kSteps + 1, 0.0);
  for (std::size_t i = 0; i <= kSteps; ++i) {
    const std::complex<double> turn = std::polar(1.0, 2 * std::numbers::pi * double(i) / kSteps);
    std::complex<double> wave = 1;
    for (std::size_t m = 0; m < cosines.size(); ++m) {
      wave *= turn;
      grey_[i] += cosines[m] * wave.real() + sines[m] * wave.imag();
      slope_[i] += double(m + 1) * unit * (sines[m] * wave.real() - cosines[m] * wave.imag());
    }
  }
}

double MarkShape::look_up(const std::vector<double>& table, double offset_px) const {
  const double turns = offset_px / pitch_px_, place = (turns - std::floor(turns)) * kSteps;
  const std::size_t i = std::min(std::size_t(place), std::size_t(kSteps - 1));
  const double part = place - double(i);
  return table[i] + part * (table[i + 1] - table[i]);
}

void MarkShape::describe() {
  const std::vector<double> v(grey_.begin(), grey_.end() - 1);
  const auto [low, high] = std::minmax_element(v.begin(), v.end());
  const double half = (*low + *high) / 2;
  const int below = int(std::count_if(v.begin(), v.end(), [half](double x) { return x < half; }));
  dark_ = 2 * below <= kSteps;
  width_px_ = std::min(below, kSteps - below) * pitch_px_ / kSteps;
  // Centre of gravity of what lies beyond the half level, about the extreme.
  const int top = int((dark_ ? low : high) - v.begin());
  double weight = 0, moment = 0;
  for (int k = -kSteps / 2; k < kSteps / 2; ++k) {
    const double beyond = (v[std::size_t((top + k + kSteps) % kSteps)] - half) * (dark_ ? -1 : 1);
    if (beyond <= 0) continue;
    weight += beyond;
    moment += beyond * k;
  }
  const double centre = (top + (weight > 0 ? moment / weight : 0)) * pitch_px_ / kSteps;
  centre_px_ = std::remainder(centre, pitch_px_);
}

MarkReading read_mark(const MarkProfile& y, double at, double pitch_px, const MarkShape& shape) {
  const double reach = std::max(pitch_px / 2, 2.5);
  const int from = int(std::ceil(at - reach - y.first_s)), to = int(std::floor(at + reach - y.first_s));
  MarkReading reading;
  if (from < 0 || to >= int(y.grey.size())) return reading;
  Eigen::Matrix3d normal = Eigen::Matrix3d::Zero();
  Eigen::Vector3d right = Eigen::Vector3d::Zero();
  double squares = 0, sum = 0;
  for (int i = from; i <= to; ++i) {
    const double v = y.grey[std::size_t(i)], offset = i + y.first_s - at;
    if (!std::isfinite(v)) return reading;
    const Eigen::Vector3d x(shape.grey(offset), -shape.slope(offset), 1);
    normal += x * x.transpose();
    right += v * x;
    squares += v * v;
    sum += v;
  }
  const Eigen::Vector3d k = normal.ldlt().solve(right);
  const double about_mean = squares - sum * sum / (to - from + 1);
  const double explained = k.dot(right) - sum * sum / (to - from + 1);
  if (!(about_mean > 0) || !k.allFinite()) return reading;
  reading.size = k[0];
  reading.shift_px = k[0] != 0 ? k[1] / k[0] : 0;
  reading.there = k[0] > 0.25 && k[0] < 4 && std::fabs(reading.shift_px) < 0.3 * pitch_px &&
                  explained > 0.25 * about_mean;
  return reading;
}

}  // namespace faba
