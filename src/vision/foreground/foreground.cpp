#include "vision/foreground/foreground.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>

#include "core/error.h"
#include "core/portable_math.h"
#include "core/statistics.h"
#include "vision/foreground/kernels/foreground_pixels.h"
#include "vision/foreground/kernels/line_closing.h"
#include "vision/foreground/spot_polarity.h"
#include "vision/image/kernels/smoothing.h"
#include "vision/image/mask.h"

namespace faba {
namespace {

constexpr double kFwhmToSd = 1 / 2.354820045;
constexpr double kFollow_s = 2;  // time constant of the update of uncovered background
constexpr float kStillAfterChange_s = 1, kStillFromStart_s = 10;
constexpr double kCorrection = 0.6;  // correction rate of background that is too dark (or bright)
constexpr double kCellsPerLine =
    9;  // length of the closing segments, in cell widths; fills cells but not lines
constexpr float kMinLineDepth = 0.3F;  // minimum depth of a cell on a line, fraction of the depth of the line
constexpr double kDilation = 0.7;      // dilation of the mask, fraction of the cell width
constexpr double kMaxRounded = 4.5;    // maximum cells of a component that is rounded to an integer number
constexpr double kFirstSd = 4;      // threshold of a cell in the first picture, in sd of the smoothed noise
constexpr double kKeyFrame_s = 20;  // twice the key frame interval of codecs, 250 frames at 25 Hz
constexpr double kCodecNoiseRatio =
    1.5;  // noise ratio to the recent maximum that indicates smoothing by a codec
constexpr double kMinThreshold =
    1;  // grey; minimum, because rounding errors are not noise-like when the light changes
constexpr double kCellUpdate = 0.2;  // weight of a new picture in the estimated signal of a cell

// Brightness of the picture relative to the background: median of the ratios outside cells.
double common_gain(const GrayF& picture, const GrayF& background,
                   const std::vector<std::uint8_t>& leave_out) {
  constexpr int kBins = 8192;  // bins for ratios from 0 to 4
  constexpr float kPerUnit = kBins / 4.0F;
  std::vector<int> count(kBins);
  int total = 0;
  for (std::size_t i = 0; i < picture.px.size(); i += 7) {
    if (leave_out[i] || !(background.px[i] > 1)) continue;
    ++count[std::size_t(std::min(int(picture.px[i] / background.px[i] * kPerUnit), kBins - 1))];
    ++total;
  }
  if (total < 100) return 1;
  int sum = 0, bin = 0;
  while (2 * (sum + count[std::size_t(bin)]) < total) sum += count[std::size_t(bin++)];
  const double inside = (0.5 * total - sum) / std::max(1, count[std::size_t(bin)]);
  return std::max(0.05, (bin + inside) * 4 / kBins);
}

}  // namespace

double picture_noise(const Gray8& picture) {
  std::array<int, 256> count{};
  int total = 0;
  for (int row = 0; row < picture.height; row += 2)
    for (int col = 0; col + 1 < picture.width; col += 2) {
      ++count[std::size_t(std::abs(int(picture.at(col + 1, row)) - int(picture.at(col, row))))];
      ++total;
    }
  if (total == 0) return 0.3;
  int sum = 0, bin = 0;
  while (2 * (sum + count[std::size_t(bin)]) < total) sum += count[std::size_t(bin++)];
  // An integer difference represents the interval of half a step to each side; a difference of 0 half that
  // width.
  const double inside = (0.5 * total - sum) / count[std::size_t(bin)];
  const double median = bin == 0 ? 0.5 * inside : bin - 0.5 + inside;
  return std::max(0.3, median / (0.6744897502 * 1.4142135624));
}

Foreground::Foreground(ForegroundOptions options) : options_(options) {
  // Differences are summed with one sign: those of dark and bright cells would cancel.
  if (options.polarity == Polarity::both)
    throw Error(Errc::internal, "foreground",
                "the polarity \"both\" is not permitted; it must be automatic, dark or bright");
  sd_px_ = options_.cell_px * kFwhmToSd;
  sign_ = options_.polarity == Polarity::dark ? -1 : options_.polarity == Polarity::bright ? 1 : 0;
}

// The first background: the picture with dark (or bright) objects that are small in every direction filled.
void Foreground::begin(const GrayF& picture, double noise) {
  const double s = std::max(sd_px_, 0.8);
  const GrayF fine = smoothed(picture, s);
  if (sign_ == 0) sign_ = spot_polarity(fine, s, noise);
  GrayF cells_dark = fine;  // inverted for bright cells, so that cells are dark
  if (sign_ > 0)
    for (float& v : cells_dark.px) v = -v;
  Pool one(1);
  const LineClosing closing = line_closing(cells_dark, kCellsPerLine * options_.cell_px, one);
  const GrayF& closed = closing.least;
  // Bias of the closing by noise, from the median, because most of the picture has no cells.
  std::vector<float> biases;
  for (std::size_t i = 0; i < closed.px.size(); i += 7) biases.push_back(closed.px[i] - cells_dark.px[i]);
  const float bias = biases.empty() ? 0 : median_high(biases);
  const auto threshold = float(std::max(kMinThreshold, kFirstSd * noise * smoothing_gain()));
  covered_.assign(picture.px.size(), 0);
  for (std::size_t i = 0; i < closed.px.size(); ++i) {
    const float depth = closing.largest.px[i] - closed.px[i];
    covered_[i] = closed.px[i] - bias - cells_dark.px[i] > std::max(threshold, kMinLineDepth * depth) ? 1 : 0;
  }
  dilate(covered_, work_, picture.width, picture.height, std::max(1, int(std::ceil(0.7 * options_.cell_px))));
  background_ = picture;
  guess_.assign(picture.px.size(), observed);
  still_grey_.assign(picture.px.size(), 0);
  still_s_.assign(picture.px.size(), 0);
  for (std::size_t i = 0; i < closed.px.size(); ++i)
    if (covered_[i]) {
      background_.px[i] = float(-sign_) * (closed.px[i] - bias);
      guess_[i] = guessed;
    }
}

// Gain of the smoothing for white noise.
double Foreground::smoothing_gain() const {
  const std::vector<float> kernel = gaussian_weights(std::max(sd_px_, 0.6));
  double square = double(kernel[0]) * double(kernel[0]);
  for (std::size_t k = 1; k < kernel.size(); ++k) square += 2 * double(kernel[k]) * double(kernel[k]);
  return square;
}

void Foreground::set_background(const Background& background) {
  constexpr double kMedianVariance = 1.5707963268;  // variance of a median over that of a mean
  background_ = background.level;
  background_noise_ = kMedianVariance / std::max(1, background.frames);
  covered_.assign(background_.px.size(), 0);
  background_given_ = true;
}

void Foreground::take(const Gray8& picture, double dt_s) {
  picture_.width = picture.width;
  picture_.height = picture.height;
  picture_.px.resize(picture.px.size());
  to_float(picture.px.data(), picture_.px.data(), int(picture.px.size()));
  process(picture_noise(picture), dt_s);
}

void Foreground::take(const GrayF& picture, double noise, double dt_s) {
  picture_ = picture;
  process(noise, dt_s);
}

void Foreground::process(double noise, double dt_s) {
  const GrayF& grey = picture_;
  const bool resized = background_.width != grey.width || background_.height != grey.height;
  if (resized) background_given_ = false;
  const bool reset = !background_given_ && (resized || !options_.learn);
  const bool learns = options_.learn && !reset && !background_given_;
  // Codecs smooth noise between key frames and restore it at the next key frame.
  recent_noise_ = std::max(noise, reset ? 0 : recent_noise_ * (1 - std::clamp(dt_s / kKeyFrame_s, 0.0, 1.0)));
  if (recent_noise_ > kCodecNoiseRatio * noise) noise = recent_noise_;
  if (reset) begin(grey, noise);
  if (sign_ == 0) sign_ = spot_polarity(smoothed(grey, std::max(sd_px_, 0.8)), std::max(sd_px_, 0.8), noise);
  weights_.width = grey.width;
  weights_.height = grey.height;
  weights_.px.resize(grey.px.size());
  const double common = reset ? 1 : common_gain(grey, background_, covered_);
  const auto gain = float(common);
  // A background from few frames is noisy itself.
  if (reset) frames_ = 0;
  find_covered(gain, noise * std::sqrt(1 + (reset ? 0 : background_noise_)));
  if (reset) background_noise_ = 1;
  // In strips, so that the data of one step are still in the cache for the next.
  constexpr int kStrip = 1 << 13;  // px
  const LightLoss loss{gain, float(noise), sign_ < 0 ? gain * middle_brightness() : 0};
  const Learning learning = learns ? learn_at(common, dt_s, noise) : Learning{};
  const int n = int(grey.px.size());
  for (int first = 0; first < n; first += kStrip) {
    const int end = std::min(n, first + kStrip);
    if (sign_ < 0) take_logarithms(loss, first, end);
    if (learns) learn(learning, first, end);
    clear_uncovered(covered_.data() + first, weights_.px.data() + first, end - first);
  }
  ++frames_;
  count_cells();
}

// Signal of one cell: the most frequent signal of the components, because single cells are the most frequent
// ones unless they touch. 0 if there are too few.
double Foreground::signal_of_one(std::vector<double> patches) const {
  constexpr std::size_t kEnough = 8;
  constexpr double kModeRatio = 1.6;  // ratio of largest to smallest signal within one mode
  std::sort(patches.begin(), patches.end());
  std::size_t most = 0, at = 0;
  for (std::size_t first = 0, end = 0; first < patches.size(); ++first) {
    if (!(patches[first] > 0)) continue;
    end = std::max(end, first);
    while (end < patches.size() && patches[end] < kModeRatio * patches[first]) ++end;
    if (end - first > most) {
      most = end - first;
      at = first;
    }
  }
  return most < kEnough ? 0 : patches[at + most / 2];
}

void Foreground::count_cells() {
  const std::size_t w = std::size_t(weights_.width);
  const auto weights_of = [&](const ComponentRun& r) { return &weights_.px[std::size_t(r.row) * w]; };
  std::vector<double> signal(
      std::size_t(connected_components(covered_, weights_.width, weights_.height, runs_)));
  for (const ComponentRun& r : runs_) {
    const float* v = weights_of(r);
    double sum = 0;
    for (int i = r.first; i < r.end; ++i) sum += double(v[i]);
    signal[std::size_t(r.patch)] += sum;
  }
  const double found = signal_of_one(signal), now = found > 0 ? found : cell_guess_;
  if (now > 0)
    cell_signal_ =
        cell_signal_ == 0 || frames_ == 1 ? now : cell_signal_ + kCellUpdate * (now - cell_signal_);
  if (!(found > 0)) return;  // the signal of one cell is only a rough estimate
  std::vector<float> factor(signal.size(), 1.0F);
  for (std::size_t k = 0; k < signal.size(); ++k)
    if (const double cells = signal[k] / cell_signal_; cells < kMaxRounded)
      factor[k] = cells > 0.5 ? float(std::round(cells) / cells) : 0.0F;
  for (const ComponentRun& r : runs_)
    if (const float by = factor[std::size_t(r.patch)]; by != 1)
      for (int i = r.first; i < r.end; ++i) weights_of(r)[i] *= by;
}

float Foreground::middle_brightness() const {
  double sum = 0, n = 0;
  for (std::size_t i = 0; i < background_.px.size(); i += 13) {
    sum += double(background_.px[i]);
    n += 1;
  }
  return float(sum / n);
}

// Cells in transmitted light absorb a fraction of it, also behind other cells: the negative logarithm of the
// transmission is additive and independent of the light (theory H5). In grey of the mean brightness.
void Foreground::take_logarithms(const LightLoss& loss, int first, int end) {
  lost_light(picture_.px.data() + first, background_.px.data() + first, covered_.data() + first, loss,
             weights_.px.data() + first, end - first);
}

void Foreground::find_covered(float gain, double noise) {
  const int w = picture_.width;
  const auto row_of = [&](int row) {
    const std::size_t first = std::size_t(row) * std::size_t(w);
    difference(&picture_.px[first], &background_.px[first], gain, float(sign_), &weights_.px[first], w);
    return &weights_.px[first];
  };
  smooth(w, picture_.height, row_of, std::max(sd_px_, 0.6), smooth_, scratch_);
  // Codecs and defocus cause correlated noise, which is larger after smoothing than white noise.
  const double left = std::max(noise * smoothing_gain(), background_given_ ? noise_below_background() : 0.0);
  const auto threshold = float(std::max(kMinThreshold, options_.threshold_sd * left));
  covered_.resize(smooth_.px.size());
  above(smooth_.px.data(), threshold, covered_.data(), int(smooth_.px.size()));
  cell_guess_ = guess_cell_signal();
  dilate(covered_, work_, weights_.width, weights_.height,
         std::max(1, int(std::lround(kDilation * options_.cell_px))));
}

// Noise of the smoothed difference, from the values with the sign opposite to that of cells.
double Foreground::noise_below_background() const {
  std::vector<float> below;
  for (std::size_t i = 0; i < smooth_.px.size(); i += 7)
    if (smooth_.px[i] < 0) below.push_back(-smooth_.px[i]);
  if (below.empty()) return 0;
  return double(median_high(below)) / 0.6744897502;
}

// Signal of one cell from the lower quartile of the maxima of the smoothed difference; larger maxima are
// overlapping cells. 0 if there are too few.
double Foreground::guess_cell_signal() const {
  std::vector<float> peaks;
  const int w = smooth_.width;
  std::vector<std::uint8_t> peak(std::size_t(std::max(w, 2)));
  for (int row = 1; row + 1 < smooth_.height; ++row) {
    const std::size_t second = std::size_t(row) * std::size_t(w) + 1;
    mark_peaks(&smooth_.px[second], w, covered_.data() + second, peak.data(), w - 2);
    each_set(peak.data(), w - 2, [&](int i) { peaks.push_back(smooth_.px[second + std::size_t(i)]); });
  }
  if (peaks.size() < (background_given_ || !options_.learn ? 1 : 5)) return 0;
  const float quartile = order_statistic(peaks, peaks.size() / 4);
  const double s = std::max(sd_px_, 0.6);
  return double(quartile) * 2 * portable::kPi * (sd_px_ * sd_px_ + s * s);
}

bool Foreground::proves_background(std::size_t i, float least_change, float dt_s) {
  const float grey = smooth_.px[i];
  const float change = std::fabs(grey - still_grey_[i]);
  if (change > least_change) {
    // The first picture does not count as a change.
    if (guess_[i] == guessed && (still_grey_[i] != 0)) guess_[i] = changed;
    still_grey_[i] = grey;
    still_s_[i] = 0;
    return false;
  }
  still_s_[i] += dt_s;
  if (still_s_[i] < (guess_[i] == changed ? kStillAfterChange_s : kStillFromStart_s)) return false;
  still_grey_[i] = grey;  // the background update subtracts it
  return true;
}

Foreground::Learning Foreground::learn_at(double gain, double dt_s, double noise) {
  // Initially the mean of all frames so far.
  const auto follow =
      float(std::max(1.0 / double(frames_ + 1), std::min(0.5, std::max(0.0, dt_s) / kFollow_s)));
  background_noise_ =
      (1 - double(follow)) * (1 - double(follow)) * background_noise_ + double(follow) * double(follow);
  const auto smooth_uncovered = -float(std::max(kMinThreshold, 4 * noise * smoothing_gain()));
  return {.follow = {.follow = follow,
                     .absorb = float(std::min(1.0, std::max(0.0, dt_s) / options_.absorb_s)),
                     .at_once = float(kCorrection),
                     .least_weight = float(-4 * noise),
                     .least_smooth = smooth_uncovered,
                     .back = float(1 / gain),
                     .next = 1 + follow * (float(gain) - 1)},  // the common brightness is updated as well
          .least_change = -1.4142135F * smooth_uncovered,      // difference of two pictures, each with noise
          .dt_s = float(dt_s)};
}

void Foreground::learn(const Learning& l, int first, int end) {
  each_set(guess_.data() + first, end - first, [&](int at) {
    const auto i = std::size_t(first) + std::size_t(at);
    if (!covered_[i] || weights_.px[i] < l.follow.least_weight || smooth_.px[i] < l.follow.least_smooth)
      return;
    if (proves_background(i, l.least_change, l.dt_s)) guess_[i] |= kDisproved;
  });
  follow_picture(picture_.px.data() + first, weights_.px.data() + first, smooth_.px.data() + first,
                 covered_.data() + first, l.follow, guess_.data() + first, background_.px.data() + first,
                 end - first);
}

SwarmMoments Foreground::moments() const {
  SwarmMoments m;
  // Coordinates relative to the picture centre, for numerical accuracy.
  const double x0 = 0.5 * (weights_.width - 1), y0 = 0.5 * (weights_.height - 1);
  double x = 0, y = 0;
  Mat2 square;
  for (const ComponentRun& r : runs_) {
    const float* v = &weights_.px[std::size_t(r.row) * std::size_t(weights_.width)];
    double one = 0, first = 0, second = 0;
    for (int i = r.first; i < r.end; ++i) {
      const double value = double(v[i]), dx = i - x0, moment = value * dx;
      one += value;
      first += moment;
      second += moment * dx;
    }
    const double dy = r.row - y0;
    m.signal += one;
    x += first;
    y += one * dy;
    square.xx += second;
    square.xy += first * dy;
    square.yy += one * dy * dy;
  }
  if (!(m.signal > 0.5 * cell_signal_) || cell_signal_ == 0) return {};
  x /= m.signal;
  y /= m.signal;
  m.centroid_image = {x0 + x, y0 + y};
  const double cell_variance = sd_px_ * sd_px_;
  m.cov_px2 = {std::max(0.0, square.xx / m.signal - x * x - cell_variance), square.xy / m.signal - x * y,
               std::max(0.0, square.yy / m.signal - y * y - cell_variance)};
  m.cells = std::max(1.0, m.signal / cell_signal_);
  return m;
}

void Foreground::archive(Archive& a) {
  a& sign_& cell_signal_& background_noise_& recent_noise_& frames_& background_.width& background_
      .height& background_.px& covered_& guess_& still_grey_& still_s_;
}

}  // namespace faba
