#include "vision/ruler/ruler_search.h"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <opencv2/imgproc.hpp>
#include <utility>

#include "core/statistics.h"
#include "vision/ruler/rotated_picture.h"

namespace faba {
namespace {

constexpr double kPi = std::numbers::pi;
constexpr int kBins = 180;   // bins of 1 degree
constexpr int kWindow = 24;  // px of a pyramid level, half width of the background estimate
constexpr double kMinLag = 2.7,
                 kMaxLag = 22;  // px of a pyramid level; larger lags are found in the next level
constexpr double kMinScore = 0.25, kMinEvidence = 6;

cv::Mat1f matrix(const GrayF& picture) {
  cv::Mat1f m(picture.height, picture.width);
  std::copy(picture.px.begin(), picture.px.end(), m.begin());
  return m;
}

GrayF image(const cv::Mat1f& m) {
  GrayF out(m.cols, m.rows);
  std::copy(m.begin(), m.end(), out.px.begin());
  return out;
}

/// Histogram of the gradient direction weighted by the squared gradient, in bins of one degree over half a
/// turn.
std::vector<double> direction_histogram(const cv::Mat1f& m, double smoothing) {
  cv::Mat1f smooth, gx, gy;
  cv::GaussianBlur(m, smooth, cv::Size(), smoothing, smoothing, cv::BORDER_REPLICATE);
  cv::Scharr(smooth, gx, CV_32F, 1, 0, 1, 0, cv::BORDER_REPLICATE);
  cv::Scharr(smooth, gy, CV_32F, 0, 1, 1, 0, cv::BORDER_REPLICATE);
  std::vector<float> sizes;
  for (int r = 0; r < m.rows; ++r)
    for (int c = 0; c < m.cols; ++c) sizes.push_back(gx(r, c) * gx(r, c) + gy(r, c) * gy(r, c));
  std::vector<float> sorted = sizes;
  // Clipping: a scale bar must not outweigh a hundred faint marks; noise below the median is ignored.
  const float most = quantile_low(sorted, 0.95), least = quantile_low(sorted, 0.5);
  std::vector<double> bins(kBins, 0.0);
  std::size_t i = 0;
  for (int r = 0; r < m.rows; ++r)
    for (int c = 0; c < m.cols; ++c, ++i) {
      if (sizes[i] <= least) continue;
      const double direction = std::atan2(double(gy(r, c)), double(gx(r, c))) / kPi;  // -1..1 for -pi..pi
      const double position = (direction - std::floor(direction)) * kBins;
      const int bin = int(position);
      const double weight = double(std::min(sizes[i], most)), part = position - bin;
      bins[std::size_t(bin % kBins)] += weight * (1 - part);
      bins[std::size_t((bin + 1) % kBins)] += weight * part;
    }
  return bins;
}

double at_bin(const std::vector<double>& bins, int i) {
  return bins[std::size_t((i % kBins + kBins) % kBins)];
}

std::vector<std::pair<double, double>> peaks(const std::vector<double>& raw) {
  std::vector<double> bins(kBins);
  double mean = 0;
  for (int i = 0; i < kBins; ++i) {
    for (int k = -2; k <= 2; ++k) bins[std::size_t(i)] += at_bin(raw, i + k) * (3 - std::abs(k)) / 9.0;
    mean += bins[std::size_t(i)] / kBins;
  }
  std::vector<std::pair<double, double>> found;  // height relative to the mean, angle
  for (int i = 0; i < kBins; ++i) {
    const double b = at_bin(bins, i);
    bool top = b > mean;
    for (int k = 1; k <= 6; ++k) top = top && b >= at_bin(bins, i - k) && b > at_bin(bins, i + k);
    if (!top) continue;
    double weight = 0, shift = 0;
    for (int k = -4; k <= 4; ++k) {
      const double w = std::max(0.0, at_bin(raw, i + k) - mean);
      weight += w;
      shift += w * k;
    }
    found.emplace_back(b / mean, (i + (weight > 0 ? shift / weight : 0)) * kPi / kBins);
  }
  return found;
}

double mean_of(const std::vector<double>& sums, int from, int to) {
  return (sums[std::size_t(to)] - sums[std::size_t(from)]) / (to - from);
}

/// The finite part of the profile, normalised to uniform background and contrast, clipped.
std::vector<double> flattened(const std::vector<double>& profile) {
  std::vector<double> y;
  for (double v : profile)
    if (std::isfinite(v)) y.push_back(v);
  const int n = int(y.size());
  const auto level = [&](const std::vector<double>& values) {
    std::vector<double> sums(values.size() + 1, 0.0), mean(values.size());
    for (std::size_t i = 0; i < values.size(); ++i) sums[i + 1] = sums[i] + values[i];
    for (int i = 0; i < n; ++i)
      mean[std::size_t(i)] = mean_of(sums, std::max(0, i - kWindow), std::min(n, i + kWindow + 1));
    return mean;
  };
  const std::vector<double> middle = level(y);
  std::vector<double> squares(y.size());
  double mean_square = 0;
  for (std::size_t i = 0; i < y.size(); ++i) {
    y[i] -= middle[i];
    squares[i] = y[i] * y[i];
    mean_square += squares[i] / n;
  }
  const std::vector<double> power = level(squares);
  for (std::size_t i = 0; i < y.size(); ++i)
    y[i] = std::clamp(y[i] / std::sqrt(power[i] + 0.1 * mean_square + 1e-30), -2.5, 2.5);
  return y;
}

std::vector<double> autocorrelation(const std::vector<double>& y, int most) {
  std::vector<double> r(std::size_t(most) + 1);
  const std::size_t n = y.size();
  for (std::size_t lag = 0; lag < r.size(); ++lag) {
    double sum = 0;
    for (std::size_t i = lag; i < n; ++i) sum += y[i] * y[i - lag];
    r[lag] = sum / double(n - lag);
  }
  return r;
}

double between(const std::vector<double>& r, double lag) {
  const std::size_t i = std::min(std::size_t(lag), r.size() - 2);
  const double f = lag - double(i);
  return r[i] * (1 - f) + r[i + 1] * f;
}

/// Autocorrelation at multiples of `lag` minus that half-way between them, normalised.
double comb_score(const std::vector<double>& r, double lag) {
  const int multiples = std::min(4, int(double(r.size() - 1) / lag));
  if (multiples < 2) return 0;
  double sum = 0;
  for (int k = 1; k <= multiples; ++k) sum += between(r, k * lag) - between(r, (k - 0.5) * lag);
  return sum / (multiples * r[0]);
}

/// Score and pitch of one strip, in px of the level; score 0 when it is not periodic.
std::pair<double, double> score_and_pitch(const std::vector<double>& profile) {
  const std::vector<double> y = flattened(profile);
  const int most = std::min(int(4 * kMaxLag), int(y.size() * 2 / 3));
  if (double(most) < 3 * kMinLag) return {0, 0};
  const std::vector<double> r = autocorrelation(y, most);
  if (r[0] <= 0) return {0, 0};
  std::vector<std::pair<double, double>> maxima;  // lag, score
  double best = 0;
  constexpr double kStep = 0.02;  // relative
  double previous = 0, current = 0;
  double next = kMinLag;
  while (next < std::min(kMaxLag, most / 2.0) * (1 + kStep)) {
    const double lag = std::exchange(next, next * (1 + kStep));
    const double next_score = comb_score(r, lag);
    if (current >= previous && current > next_score && current > 0) {
      maxima.emplace_back(lag / (1 + kStep), current);
      best = std::max(best, current);
    }
    previous = current;
    current = next_score;
  }
  for (const auto& [lag, score] : maxima)
    if (score > 0.7 * best) return {score, lag};
  return {0, 0};
}

void search_level(const GrayF& copy, double angle, double factor, std::vector<PeriodHint>& hints) {
  const RotatedPicture rotated(copy, angle);
  for (const int height : {6, 18, 54}) {
    if (height > copy.height && height > copy.width) break;
    const double reach = rotated.last_t() - rotated.first_t() + 1 - height;
    const double stride = std::max(height / 2.0, reach / 300);
    double next = rotated.first_t() + (height - 1) / 2.0;
    while (next <= rotated.last_t()) {
      const double t = std::exchange(next, next + stride);
      const std::vector<double> profile = rotated.profile(t, height);
      const auto valid_count =
          std::count_if(profile.begin(), profile.end(), [](double v) { return std::isfinite(v); });
      if (double(valid_count) < 4 * kMinLag) continue;
      const auto [score, lag] = score_and_pitch(profile);
      const double evidence = score * std::sqrt(double(valid_count));
      if (score > kMinScore && evidence > kMinEvidence)
        hints.push_back({angle, lag * factor, t * factor, int(std::lround(height * factor)), evidence});
    }
  }
}

}  // namespace

std::vector<double> edge_directions(const GrayF& picture, int most) {
  const cv::Mat1f m = matrix(picture);
  std::vector<std::pair<double, double>> all;
  for (const double smoothing : {1.0, 3.0})
    for (const auto& p : peaks(direction_histogram(m, smoothing))) all.push_back(p);
  std::sort(all.rbegin(), all.rend());
  std::vector<double> out;
  const auto add_direction = [&](double angle) {
    const bool duplicate = std::any_of(out.begin(), out.end(), [angle](double b) {
      return std::fabs(std::remainder(angle - b, kPi)) < 2.5 * kPi / 180;
    });
    if (!duplicate && int(out.size()) < most) out.push_back(angle - kPi * std::floor(angle / kPi + 0.5));
  };
  for (const auto& [height, angle] : all) {
    add_direction(angle);
    add_direction(angle + kPi / 2);  // fine marks may be too faint, but the edges of the ruler are not
  }
  return out;
}

std::vector<PeriodHint> find_periods(const GrayF& picture) {
  std::vector<PeriodHint> hints;
  cv::Mat1f copy = matrix(picture);
  const std::vector<double> directions = edge_directions(picture, 8);
  for (double factor = 1; std::min(copy.cols, copy.rows) >= 12; factor *= 2) {
    const GrayF level = image(copy);
    for (const double angle : directions) search_level(level, angle, factor, hints);
    cv::Mat1f half;
    cv::resize(copy, half, cv::Size(copy.cols / 2, copy.rows / 2), 0, 0, cv::INTER_AREA);
    copy = half;
    if (std::max(copy.cols, copy.rows) < 40) break;
  }
  std::stable_sort(hints.begin(), hints.end(),
                   [](const PeriodHint& a, const PeriodHint& b) { return a.evidence > b.evidence; });
  return hints;
}

}  // namespace faba
