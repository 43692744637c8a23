#include "vision/cells/detector.h"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <utility>

#include "core/error.h"
#include "core/statistics.h"
#include "vision/cells/spot_fit.h"
#include "vision/image/coding_traces.h"
#include "vision/image/kernels/any_above.h"
#include "vision/image/kernels/arithmetic.h"
#include "vision/image/kernels/smoothing.h"

namespace faba {
namespace {

constexpr double kSurroundRatio = 2.5;  // sd of the subtracted Gaussian over that of the spot

// Response of the band pass to white noise: its gain, and the density of maxima (square root of the
// determinant of the second spectral moments over the variance).
struct NoiseResponse {
  double gain = 1, density = 1;
};

NoiseResponse noise_response(double sd) {
  // The kernel is G(a) - G(b); the integral of the product of two Gaussians with variances a^2 and b^2 is a
  // Gaussian of variance a^2 + b^2 at zero.
  const auto overlap = [](double aa) { return 1 / (2 * std::numbers::pi * aa); };
  const auto slope = [](double aa) { return 1 / (2 * std::numbers::pi * aa * aa); };
  // Sampling adds 1/12 px^2 of variance, which is relevant for the narrowest kernels only.
  const double a = sd * sd + 1.0 / 12, b = kSurroundRatio * kSurroundRatio * sd * sd;
  const double variance = overlap(2 * a) + overlap(2 * b) - 2 * overlap(a + b);
  const double gradient = slope(2 * a) + slope(2 * b) - 2 * slope(a + b);
  return {std::sqrt(variance), gradient / variance};
}

GrayF band_passed(const GrayF& difference, double sd) {
  GrayF out = smoothed(difference, sd);
  subtract(out, smoothed(difference, kSurroundRatio * sd));
  return out;
}

GrayF difference_of(const GrayF& frame, const Background& background, double sign) {
  return sign > 0 ? difference(frame, background.level) : difference(background.level, frame);
}

// A maximum of the response of spots of one size.
struct ScaledMaximum {
  Vec2 at;
  double snr = 0, size = 0;
};

struct Maximum {
  int col = 0, row = 0;
  float value = 0;
};

/// A threshold for all pixels, or with a weight for each.
struct Threshold {
  float value = 0;
  const float* weights = nullptr;
  float at(std::size_t i) const { return weights ? value * weights[i] : value; }
  bool any_in(const GrayF& g, std::size_t begin, int n) const {
    return any_above(&g.px[begin], weights ? weights + begin : nullptr, value, n);
  }
};

bool is_maximum(const GrayF& g, int col, int row, int reach) {
  const float v = g.at(col, row);
  const bool inner = col > 0 && row > 0 && col + 1 < g.width && row + 1 < g.height;
  // Most pixels of a spot are excluded by their nearest neighbours.
  if (inner &&
      (g.at(col - 1, row) > v || g.at(col + 1, row) > v || g.at(col, row - 1) > v || g.at(col, row + 1) > v))
    return false;
  for (int dy = -reach; dy <= reach; ++dy)
    for (int dx = -reach; dx <= reach; ++dx) {
      const int c = col + dx, r = row + dy;
      if ((dx == 0 && dy == 0) || dx * dx + dy * dy > reach * reach + 1 || c < 0 || r < 0 || c >= g.width ||
          r >= g.height)
        continue;
      const float other = g.at(c, r);
      if (!(v > other || (v == other && (dy > 0 || (dy == 0 && dx > 0))))) return false;
    }
  return true;
}

// Local maxima above the threshold within radius `reach`; the first one of equal values.
std::vector<Maximum> maxima(const GrayF& g, int reach, int margin, const Threshold& threshold) {
  constexpr int kAtOnce = 128;  // px of a row; most contain nothing
  std::vector<Maximum> out;
  for (int row = margin; row < g.height - margin; ++row)
    for (int first = margin; first < g.width - margin; first += kAtOnce) {
      const int end = std::min(first + kAtOnce, g.width - margin);
      const std::size_t start = std::size_t(row) * std::size_t(g.width);
      if (!threshold.any_in(g, start + std::size_t(first), end - first)) continue;
      for (int col = first; col < end; ++col)
        if (const float v = g.at(col, row);
            v > threshold.at(start + std::size_t(col)) && is_maximum(g, col, row, reach))
          out.push_back({col, row, v});
    }
  return out;
}

float spread_of(const GrayF& g) {
  std::vector<float> work;
  const std::size_t step = std::max<std::size_t>(1, g.px.size() / 100000);
  for (std::size_t i = 0; i < g.px.size(); i += step) work.push_back(g.px[i]);
  return work.empty() ? 0 : robust_spread_low(work).sd;
}

// The significant maxima of spots of one size, with their signal-to-noise ratios relative to white noise: the
// measured noise is not comparable between sizes because of defocused objects and smoothing by codecs.
std::vector<ScaledMaximum> significant_maxima(const GrayF& frame, const Background& background,
                                              Polarity polarity, double size) {
  constexpr double kMinSnr = 6;
  const double sd = size / kFwhmPerSd, gain = noise_response(sd).gain;
  std::vector<ScaledMaximum> out;
  for (const double sign : {-1.0, 1.0}) {
    if (polarity == (sign > 0 ? Polarity::dark : Polarity::bright)) continue;
    const GrayF response = band_passed(difference_of(frame, background, sign), sd);
    const float noise = std::max(spread_of(response), float(gain) * 0.25F);
    const float least = float(kMinSnr) * noise;
    for (const Maximum& m : maxima(response, std::max(1, int(sd)), 2, Threshold{least}))
      out.push_back({{double(m.col), double(m.row)}, double(m.value) / gain, size});
  }
  std::sort(out.begin(), out.end(),
            [](const ScaledMaximum& a, const ScaledMaximum& b) { return a.snr > b.snr; });
  return out;
}

/// Objects in squares of a picture, to search the neighbours of a place.
class ObjectGrid {
 public:
  /// `reach`: px, the largest distance of near().
  ObjectGrid(const GrayF& picture, double reach)
      : side_(reach), columns_(1 + int(picture.width / reach)), rows_(1 + int(picture.height / reach)) {
    squares_.resize(std::size_t(columns_) * std::size_t(rows_));
  }
  void add(const ScaledMaximum& m) { square(column_of(m.at), row_of(m.at)).push_back(m); }
  /// Whether there is an object closer than half of the larger size.
  bool near(const ScaledMaximum& m) const {
    const int column = column_of(m.at), row = row_of(m.at);
    for (int r = std::max(0, row - 1); r <= std::min(row + 1, rows_ - 1); ++r)
      for (int c = std::max(0, column - 1); c <= std::min(column + 1, columns_ - 1); ++c)
        for (const ScaledMaximum& o : squares_[std::size_t(r) * std::size_t(columns_) + std::size_t(c)])
          if (norm(o.at - m.at) < 0.5 * std::max(o.size, m.size)) return true;
    return false;
  }

 private:
  int column_of(Vec2 at) const { return int(at.x / side_); }
  int row_of(Vec2 at) const { return int(at.y / side_); }
  std::vector<ScaledMaximum>& square(int column, int row) {
    return squares_[std::size_t(row) * std::size_t(columns_) + std::size_t(column)];
  }

  double side_;
  int columns_, rows_;
  std::vector<std::vector<ScaledMaximum>> squares_;
};

// The number of objects whose response is largest at each size.
std::vector<double> objects_of_sizes(const std::vector<std::vector<ScaledMaximum>>& maxima,
                                     const std::vector<double>& sizes, const GrayF& picture) {
  std::vector<ScaledMaximum> all;
  for (const auto& of_size : maxima) all.insert(all.end(), of_size.begin(), of_size.end());
  std::sort(all.begin(), all.end(),
            [](const ScaledMaximum& a, const ScaledMaximum& b) { return a.snr > b.snr; });
  ObjectGrid objects(picture, 0.5 * sizes.back());
  std::vector<double> counts(sizes.size());
  for (const ScaledMaximum& m : all) {
    if (objects.near(m)) continue;  // the other sizes respond to the same object, less strongly
    objects.add(m);
    counts[std::size_t(std::find(sizes.begin(), sizes.end(), m.size) - sizes.begin())] += 1;
  }
  return counts;
}

// Two sizes that differ by a factor of two or more: the most frequent one, and the `estimate` or another
// frequent one. Sizes are counted with their neighbours.
std::optional<TwoSizes> two_sizes(const std::vector<double>& objects, const std::vector<double>& sizes,
                                  double estimate) {
  constexpr double kFactor = 2, kFrequent = 0.2, kFew = 5, kValley = 0.5;  // assumed
  std::vector<double> n(sizes.size());
  for (std::size_t k = 0; k < n.size(); ++k)
    for (std::size_t i = k > 0 ? k - 1 : 0; i <= std::min(k + 1, n.size() - 1); ++i) n[k] += objects[i];
  const auto mode = std::size_t(std::max_element(n.begin(), n.end()) - n.begin());
  const auto pair_with = [&](double size) {
    return TwoSizes{std::min(size, sizes[mode]), std::max(size, sizes[mode])};
  };
  const auto apart = [&](double size) {
    return pair_with(size).larger_px >= kFactor * pair_with(size).smaller_px;
  };
  if (n[mode] < kFew) return {};
  if (apart(estimate)) {
    TwoSizes pair = pair_with(estimate);
    pair.most_have_other = true;
    return pair;
  }
  std::optional<std::size_t> other;
  for (std::size_t k = 0; k < n.size(); ++k) {
    if (!apart(sizes[k]) || n[k] < std::max(kFew, kFrequent * n[mode])) continue;
    const auto [low, high] = std::minmax(k, mode);
    const bool valley =
        *std::min_element(n.begin() + std::ptrdiff_t(low), n.begin() + std::ptrdiff_t(high)) < kValley * n[k];
    if (valley && (!other || n[k] > n[*other])) other = k;
  }
  return other ? std::optional(pair_with(sizes[*other])) : std::nullopt;
}

}  // namespace

bool excludes(const std::optional<DropMask>& drop, double x_px, double y_px) {
  if (!drop) return false;
  const double depth = drop->radius_px - norm(Vec2{x_px, y_px} - drop->centre_image);
  return (drop->inside ? depth : -depth) < drop->margin_px;
}

double detection_threshold(double size_px, double pixels, double false_alarms) {
  const double sd = size_px / kFwhmPerSd;
  const double scale = pixels * noise_response(sd).density / std::pow(2 * std::numbers::pi, 1.5);
  const auto expected = [&](double k) { return scale * k * std::exp(-0.5 * k * k); };
  double low = 1, high = 40;  // expected() decreases for k > 1
  for (int i = 0; i < 100; ++i) {
    const double k = 0.5 * (low + high);
    (expected(k) > false_alarms ? low : high) = k;
  }
  return high;
}

Detector::Detector(Background background, DetectorOptions options)
    : background_(std::move(background)), options_(options) {
  if (!(options_.size_px >= 1 && options_.size_px <= kLargestDetected) ||
      options_.polarity == Polarity::automatic || !(options_.false_alarms > 0) || background_.level.empty())
    throw Error(Errc::internal, "detector",
                "invalid options; a background, a size of 1 to 60 px, false_alarms > 0 and a polarity other "
                "than automatic are required");
  sd_px_ = options_.size_px / kFwhmPerSd;
  if (options_.separation_px <= 0) options_.separation_px = std::max(1.0, 0.5 * options_.size_px);
  threshold_ =
      options_.threshold_sd > 0
          ? options_.threshold_sd
          : detection_threshold(options_.size_px, double(background_.level.px.size()), options_.false_alarms);
  noise_gain_ = noise_response(sd_px_).gain;
  const std::vector<float>& noise = background_.noise_sd.px;
  if (options_.coded || std::all_of(noise.begin(), noise.end(), [&](float v) { return v == noise[0]; }))
    return;
  relative_noise_ = background_.noise_sd;
  std::vector<float> work = noise;
  const float typical = robust_spread_low(work).median;
  for (float& v : relative_noise_.px) v /= typical;
}

double Detector::relative_noise(int col, int row) const {
  return relative_noise_.empty() ? 1 : double(relative_noise_.at(col, row));
}

std::vector<Spot> Detector::find(const GrayF& frame) const {
  if (frame.width != background_.level.width || frame.height != background_.level.height)
    throw Error(Errc::internal, "detector", "the frame differs in size from the background");
  std::vector<Spot> spots;
  const int reach = std::max(1, int(std::lround(options_.separation_px)));
  const int margin = std::max(1, int(std::ceil(0.5 * options_.size_px)));
  for (const double sign : {-1.0, 1.0}) {
    if (options_.polarity == (sign > 0 ? Polarity::dark : Polarity::bright)) continue;
    const GrayF difference = difference_of(frame, background_, sign);
    const GrayF response = band_passed(difference, sd_px_);
    const float sd = options_.coded ? std::max(spread_of(response), coded_noise(difference, response))
                                    : spread_of(response);
    // A uniform picture, or one whose noise was removed by a codec, has zero spread: the quantisation step is
    // then the noise.
    const float noise = std::max(sd, float(noise_gain_) * 0.25F);
    const Threshold threshold{float(threshold_) * noise,
                              relative_noise_.empty() ? nullptr : relative_noise_.px.data()};
    std::vector<SpotSeed> seeds;
    for (const Maximum& m : maxima(response, reach, margin, threshold)) {
      if (excludes(options_.drop, m.col, m.row)) continue;
      const double local = double(noise) * relative_noise(m.col, m.row);
      double pixel_noise = double(background_.noise_sd.at(m.col, m.row));
      if (options_.coded) pixel_noise = std::max(pixel_noise, double(noise) / noise_gain_);
      seeds.push_back({m.col, m.row, double(m.value) / local, pixel_noise});
    }
    for (Spot& spot : fit_spots(difference, seeds, sd_px_)) {
      spot.bright = sign > 0;
      if (!excludes(options_.drop, spot.x_px, spot.y_px)) spots.push_back(spot);
    }
  }
  std::stable_sort(spots.begin(), spots.end(), [](const Spot& a, const Spot& b) { return a.y_px < b.y_px; });
  return spots;
}

SpotSize spot_size(const GrayF& frame, const Background& background, Polarity polarity, Pool& pool) {
  std::vector<double> sizes;
  double next = kSmallestSpot;
  while (next < kLargestSpot && 8 * next / kFwhmPerSd <= std::min(frame.width, frame.height)) {
    sizes.push_back(next);
    next *= 1.2;
  }
  std::vector<std::vector<ScaledMaximum>> maxima(sizes.size());
  pool.run_uneven(sizes.size(), [&](std::size_t i) {
    const std::size_t k = sizes.size() - 1 - i;  // the large sizes take longest
    maxima[k] = significant_maxima(frame, background, polarity, sizes[k]);
  });
  double best = 0;
  SpotSize out;
  std::size_t count = 0;
  for (std::size_t k = 0; k < sizes.size(); ++k) {
    // The same number of maxima is used for every size: the strongest fifth at the first size with
    // significant maxima.
    if (count == 0 && !maxima[k].empty()) count = std::max<std::size_t>(1, maxima[k].size() / 5);
    double sum = 0;
    for (std::size_t i = 0; i < std::min(count, maxima[k].size()); ++i) sum += maxima[k][i].snr;
    if (sum > best) {
      best = sum;
      out.px = sizes[k];
    }
  }
  if (out.px > 0) out.two = two_sizes(objects_of_sizes(maxima, sizes, frame), sizes, out.px);
  return out;
}

}  // namespace faba
