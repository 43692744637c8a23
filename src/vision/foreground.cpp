#include "vision/foreground.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <cstring>

#include "core/portable_math.h"
#include "vision/smoothing.h"

namespace faba {
namespace {

constexpr double kFwhmToSd = 1 / 2.354820045;
constexpr double kFollow_s = 2;   // in which uncovered background follows the picture
constexpr double kUncover = 0.6;  // share by which background that proves too dark (or bright) is corrected
constexpr double kCurvatureSd =
    3.5;  // of the noise of a curvature, from which on a spot is one: a false one is harmless
constexpr float kSpotShape =
    0.15F;  // smaller over larger curvature of a spot; a rod twice as long as wide has 0.25
constexpr float kFaint = 0.3F;         // of the median spot's curvature, below which there is none
constexpr int kGrowths = 8;            // by a cell each, of what the first spots cover
constexpr double kGrowthSd = 3;        // of the smoothed noise, and at least
constexpr double kGrowthShare = 0.2;   // of what one cell shows: the foot of a cell is not worth growing over
constexpr double kGrowthWide = 8;      // sd of a cell: the surroundings that a crowd is compared with
constexpr double kLeastThreshold = 1;  // grey: rounding does not look like noise when the light changes
constexpr double kCellMemory = 0.05;   // share of a new picture in what a cell is thought to weigh

// Marks every pixel within `reach` of a marked one, in a square.
void dilate(std::vector<std::uint8_t>& m, std::vector<std::uint8_t>& work, int w, int h, int reach) {
  work.assign(m.size(), 0);
  for (int row = 0; row < h; ++row) {
    const std::uint8_t* in = &m[std::size_t(row) * std::size_t(w)];
    std::uint8_t* out = &work[std::size_t(row) * std::size_t(w)];
    for (int k = -reach; k <= reach; ++k) {
      const int first = std::max(0, -k), end = std::min(w, w - k);
      for (int i = first; i < end; ++i) out[i] |= in[i + k];
    }
  }
  m.assign(m.size(), 0);
  for (int row = 0; row < h; ++row) {
    std::uint8_t* out = &m[std::size_t(row) * std::size_t(w)];
    for (int r = std::max(0, row - reach); r <= std::min(h - 1, row + reach); ++r) {
      const std::uint8_t* in = &work[std::size_t(r) * std::size_t(w)];
      for (int i = 0; i < w; ++i) out[i] |= in[i];
    }
  }
}

// The two curvatures of a surface, in the direction of `sign` (+1: of bright spots), the smaller first.
struct Curvatures {
  float small, large;
};
Curvatures curvatures(const GrayF& g, int col, int row, float sign) {
  const float v = g.at(col, row), l = g.at(col - 1, row), r = g.at(col + 1, row), u = g.at(col, row - 1),
              d = g.at(col, row + 1);
  const float xx = sign * (2 * v - l - r), yy = sign * (2 * v - u - d);
  const float xy =
      sign * 0.25F *
      (g.at(col + 1, row - 1) + g.at(col - 1, row + 1) - g.at(col + 1, row + 1) - g.at(col - 1, row - 1));
  const float half = 0.5F * (xx - yy), mean = 0.5F * (xx + yy), apart = std::sqrt(half * half + xy * xy);
  return {mean - apart, mean + apart};
}

// Where a picture is bent like a spot, and where like a line.
struct Marks {
  std::vector<std::uint8_t> spots, lines;
  std::vector<float> strengths;  // smaller curvatures of the spots
  double evidence = 0;           // their sum
};

// Curvatures from `least` on count; spots are not looked for within `border` px of the border.
Marks find_marks(const GrayF& smooth, float sign, float least, int border) {
  const int w = smooth.width, h = smooth.height;
  Marks m;
  m.spots.assign(smooth.px.size(), 0);
  m.lines.assign(smooth.px.size(), 0);
  for (int row = 1; row + 1 < h; ++row)
    for (int col = 1; col + 1 < w; ++col) {
      const Curvatures c = curvatures(smooth, col, row, sign);
      if (c.large <= least) continue;
      const std::size_t i = std::size_t(row) * std::size_t(w) + std::size_t(col);
      const bool inside = col >= border && row >= border && col + border < w && row + border < h;
      const bool spot = inside && c.small > least && c.small > kSpotShape * c.large;
      (spot ? m.spots : m.lines)[i] = 1;
      if (!spot) continue;
      m.strengths.push_back(c.small);
      m.evidence += double(c.small);
    }
  return m;
}

// Brightness of the picture over that of the background: median of the quotients, where no cells are.
double common_gain(const GrayF& picture, const GrayF& background,
                   const std::vector<std::uint8_t>& leave_out) {
  constexpr int kBins = 8192;  // of quotients from 0 to 4
  std::vector<int> count(kBins);
  int total = 0;
  for (std::size_t i = 0; i < picture.px.size(); i += 7) {
    if (leave_out[i] || !(background.px[i] > 1)) continue;
    ++count[std::size_t(std::min(int(picture.px[i] / background.px[i] * (kBins / 4)), kBins - 1))], ++total;
  }
  if (total < 100) return 1;
  int sum = 0, bin = 0;
  while (2 * (sum + count[std::size_t(bin)]) < total) sum += count[std::size_t(bin++)];
  const double inside = (0.5 * total - sum) / std::max(1, count[std::size_t(bin)]);
  return std::max(0.05, (bin + inside) * 4 / kBins);
}

// What is marked is filled in from what is neither marked nor a line: means over wider and wider
// surroundings.
GrayF filled_in(const GrayF& picture, const std::vector<std::uint8_t>& marked,
                const std::vector<std::uint8_t>& lines, double first_sd_px) {
  GrayF out = picture, left = picture, weight(picture.width, picture.height);
  std::vector<std::uint8_t> open = marked;
  for (std::size_t i = 0; i < left.px.size(); ++i)
    weight.px[i] = marked[i] || lines[i] ? 0.0F : 1.0F, left.px[i] *= weight.px[i];
  for (double sd = first_sd_px; sd < 4.0 * (picture.width + picture.height); sd *= 2.5) {
    const GrayF sums = smoothed(left, sd), weights = smoothed(weight, sd);
    bool all = true;
    for (std::size_t i = 0; i < out.px.size(); ++i) {
      if (!open[i]) continue;
      if (weights.px[i] > 0.1F) out.px[i] = sums.px[i] / weights.px[i], open[i] = 0;
      all = all && !open[i];
    }
    if (all) break;
  }
  return out;
}

}  // namespace

double picture_noise(const Gray8& picture) {
  std::array<int, 256> count{};
  int total = 0;
  for (int row = 0; row < picture.height; row += 2)
    for (int col = 0; col + 1 < picture.width; col += 2)
      ++count[std::size_t(std::abs(int(picture.at(col + 1, row)) - int(picture.at(col, row))))], ++total;
  if (total == 0) return 0.3;
  int sum = 0, bin = 0;
  while (2 * (sum + count[std::size_t(bin)]) < total) sum += count[std::size_t(bin++)];
  // A whole step stands for the values half a step about it; differences of nothing for half that width.
  const double inside = (0.5 * total - sum) / count[std::size_t(bin)];
  const double median = bin == 0 ? 0.5 * inside : bin - 0.5 + inside;
  return std::max(0.3, median / (0.6744897502 * 1.4142135624));
}

Foreground::Foreground(ForegroundOptions options) : options_(options) {
  sd_px_ = options_.cell_px * kFwhmToSd;
  sign_ = options_.polarity == Polarity::dark ? -1 : options_.polarity == Polarity::bright ? 1 : 0;
}

// The first background: the picture without its spots.
void Foreground::begin(const GrayF& picture, double noise) {
  const int w = picture.width, h = picture.height;
  const GrayF fine = smoothed(picture, std::max(sd_px_, 0.8));
  // Noise of a second difference of the smoothed picture; its variance is 3 / (16 pi s^6) of the noise's.
  const double s = std::max(sd_px_, 0.8);
  const auto least = float(kCurvatureSd * noise * std::sqrt(3 / (16 * portable::kPi)) / (s * s * s));
  // Mirrored at the border, a line that meets it looks bent.
  const int border = 1 + int(std::ceil(4 * s));
  std::array<Marks, 2> marks;
  for (std::size_t k = 0; k < 2; ++k) {
    const float sign = k == 0 ? -1.0F : 1.0F;
    marks[k] = find_marks(fine, sign, least, border);
    if (marks[k].strengths.empty()) continue;
    // In a picture with little noise the foot of each cell is a surface with a shape, too.
    auto& v = marks[k].strengths;
    const auto middle = v.begin() + std::ptrdiff_t(v.size() / 2);
    std::nth_element(v.begin(), middle, v.end());
    marks[k] = find_marks(fine, sign, std::max(least, kFaint * *middle), border);
  }
  if (sign_ == 0) sign_ = marks[1].evidence > marks[0].evidence ? 1 : -1;
  std::vector<std::uint8_t>&marked = marks[sign_ > 0 ? 1 : 0].spots, &line = marks[sign_ > 0 ? 1 : 0].lines;
  const int cell = int(std::ceil(options_.cell_px));
  const std::vector<std::uint8_t> ridge = line;
  dilate(marked, work_, w, h, cell);
  dilate(line, work_, w, h, cell);
  // Where cells lie on cells there are no spots; what differs from the surroundings next to spots belongs to
  // them.
  const auto differs = [&](const std::vector<std::uint8_t>& covered) {
    const GrayF wide = filled_in(picture, covered, line, kGrowthWide * sd_px_);
    GrayF d(w, h);
    for (std::size_t i = 0; i < d.px.size(); ++i) d.px[i] = float(sign_) * (picture.px[i] - wide.px[i]);
    return smoothed(d, std::max(sd_px_, 0.6));
  };
  smooth_ = differs(marked);
  const double least_noise = kGrowthSd * noise * smoothing_gain();
  measure_cell(least_noise);
  const double s0 = std::max(sd_px_, 0.6),
               peak = cell_signal_ / (2 * portable::kPi * (sd_px_ * sd_px_ + s0 * s0));
  const auto threshold = float(std::max({kLeastThreshold, least_noise, kGrowthShare * peak}));
  for (int round = 0; round < kGrowths; ++round) {
    std::vector<std::uint8_t> near = marked;
    dilate(near, work_, w, h, cell);
    std::size_t added = 0;
    for (std::size_t i = 0; i < near.size(); ++i)
      if (near[i] && !marked[i] && !ridge[i] && smooth_.px[i] > threshold) marked[i] = 1, ++added;
    if (added == 0) break;
    smooth_ = differs(marked);
  }
  background_ = filled_in(picture, marked, line, 5 * sd_px_);
}

// What the smoothing leaves of white noise.
double Foreground::smoothing_gain() const {
  const std::vector<float> kernel = gaussian_weights(std::max(sd_px_, 0.6));
  double square = double(kernel[0]) * double(kernel[0]);
  for (std::size_t k = 1; k < kernel.size(); ++k) square += 2 * double(kernel[k]) * double(kernel[k]);
  return square;
}

void Foreground::take(const Gray8& picture, double dt_s) {
  const double noise = picture_noise(picture);
  GrayF& grey = picture_;
  grey.width = picture.width, grey.height = picture.height;
  grey.px.resize(picture.px.size());
  for (std::size_t i = 0; i < grey.px.size(); ++i) grey.px[i] = float(picture.px[i]);
  const bool anew =
      background_.width != picture.width || background_.height != picture.height || !options_.learn;
  if (anew) begin(grey, noise), covered_.assign(grey.px.size(), 0);
  weights_.width = grey.width, weights_.height = grey.height;
  weights_.px.resize(grey.px.size());
  const auto sign = float(sign_);
  const double common = anew ? 1 : common_gain(grey, background_, covered_);
  const auto gain = float(common);
  for (std::size_t i = 0; i < grey.px.size(); ++i)
    weights_.px[i] = sign * (grey.px[i] - gain * background_.px[i]);
  // A background that rests on few frames has their noise.
  if (anew) frames_ = 0;
  find_covered(noise * std::sqrt(1 + (anew ? 0 : own_noise_)));
  if (anew) own_noise_ = 1;
  if (sign_ < 0) take_logarithms(grey, gain, noise);
  if (options_.learn && !anew) learn(grey, common, dt_s, noise);
  ++frames_;
  for (std::size_t i = 0; i < weights_.px.size(); ++i)
    if (!covered_[i]) weights_.px[i] = 0;
}

// Cells in transmitted light take away a share of it, and so do cells behind cells: the logarithm of the
// light that is left adds up, whatever the light (theory H5). In grey of the middle brightness.
void Foreground::take_logarithms(const GrayF& picture, float gain, double noise) {
  double sum = 0, n = 0;
  for (std::size_t i = 0; i < background_.px.size(); i += 13) sum += double(background_.px[i]), n += 1;
  const float level = gain * float(sum / n);
  for (std::size_t i = 0; i < weights_.px.size(); ++i) {
    if (!covered_[i]) continue;
    const float light = std::max(1.0F, gain * background_.px[i]);
    const float left = std::max(std::max(1.0F, 0.02F * light), picture.px[i]) / light;
    // Noise alone makes the mean logarithm smaller by half its square.
    const float relative = float(noise) / light;
    weights_.px[i] = level * (-portable::log(left) - 0.5F * relative * relative);
  }
}

void Foreground::find_covered(double noise) {
  const auto threshold = float(std::max(kLeastThreshold, options_.threshold_sd * noise * smoothing_gain()));
  smooth(weights_, std::max(sd_px_, 0.6), smooth_, scratch_);
  covered_.resize(smooth_.px.size());
  for (std::size_t i = 0; i < smooth_.px.size(); ++i) covered_[i] = smooth_.px[i] > threshold ? 1 : 0;
  measure_cell(double(threshold));
  dilate(covered_, work_, weights_.width, weights_.height,
         std::max(1, int(std::ceil(0.7 * options_.cell_px))));
}

// A cell's signal from the lower quartile of the maxima of the smoothed difference: the others are several
// cells, or in them.
void Foreground::measure_cell(double threshold) {
  std::vector<float> peaks;
  const int w = smooth_.width;
  const auto least = float(threshold);
  for (int row = 1; row + 1 < smooth_.height; ++row)
    for (int col = 1; col + 1 < w; ++col) {
      const float* at = &smooth_.px[std::size_t(row) * std::size_t(w) + std::size_t(col)];
      const float v = *at;
      if (v <= least || v < at[-1] || v <= at[1] || v < at[-w] || v <= at[w] || v < at[-w - 1] ||
          v < at[1 - w] || v <= at[w - 1] || v <= at[w + 1])
        continue;
      peaks.push_back(v);
    }
  if (peaks.size() < 5) return;
  const auto quartile = peaks.begin() + std::ptrdiff_t(peaks.size() / 4);
  std::nth_element(peaks.begin(), quartile, peaks.end());
  const double s = std::max(sd_px_, 0.6);
  const double signal = double(*quartile) * 2 * portable::kPi * (sd_px_ * sd_px_ + s * s);
  cell_signal_ = cell_signal_ == 0 ? signal : cell_signal_ + kCellMemory * (signal - cell_signal_);
}

void Foreground::learn(const GrayF& picture, double gain, double dt_s, double noise) {
  // At first the mean of all frames so far.
  const auto follow =
      float(std::max(1.0 / double(frames_ + 1), std::min(0.5, std::max(0.0, dt_s) / kFollow_s)));
  own_noise_ = (1 - double(follow)) * (1 - double(follow)) * own_noise_ + double(follow) * double(follow);
  const auto absorb = float(std::min(1.0, std::max(0.0, dt_s) / options_.absorb_s));
  const auto uncovered = float(-4 * noise), back = float(1 / gain);
  // The common brightness is followed too.
  const float next = 1 + follow * (float(gain) - 1);
  for (std::size_t i = 0; i < picture.px.size(); ++i) {
    const float rate = weights_.px[i] < uncovered ? float(kUncover) : covered_[i] ? absorb : follow;
    background_.px[i] = next * (background_.px[i] + rate * (back * picture.px[i] - background_.px[i]));
  }
}

SwarmMoments Foreground::moments() const {
  SwarmMoments m;
  const int w = weights_.width;
  // Calls visit(row, first column, end column) for what each row may hold.
  const auto each_row = [&](const auto& visit) {
    for (int row = 0; row < weights_.height; ++row) {
      const std::uint8_t* covered = &covered_[std::size_t(row) * std::size_t(w)];
      const auto* first = static_cast<const std::uint8_t*>(std::memchr(covered, 1, std::size_t(w)));
      if (!first) continue;
      int end = w;
      while (!covered[end - 1]) --end;
      visit(row, int(first - covered), end);
    }
  };
  double x = 0, y = 0;
  each_row([&](int row, int first, int end) {
    double sum = 0, sum_x = 0;
    for (int col = first; col < end; ++col) {
      const auto v = double(weights_.at(col, row));
      sum += v, sum_x += v * col;
    }
    m.signal += sum, x += sum_x, y += sum * row;
  });
  if (!(m.signal > 0.5 * cell_signal_) || cell_signal_ == 0) return {};
  m.centroid_image = {x / m.signal, y / m.signal};
  each_row([&](int row, int first, int end) {
    const double dy = row - m.centroid_image.y;
    for (int col = first; col < end; ++col) {
      const double v = double(weights_.at(col, row)), dx = col - m.centroid_image.x;
      m.cov_px2.xx += v * dx * dx, m.cov_px2.xy += v * dx * dy, m.cov_px2.yy += v * dy * dy;
    }
  });
  const double own = sd_px_ * sd_px_;
  m.cov_px2 = {std::max(0.0, m.cov_px2.xx / m.signal - own), m.cov_px2.xy / m.signal,
               std::max(0.0, m.cov_px2.yy / m.signal - own)};
  m.cells = std::max(1.0, m.signal / cell_signal_);
  return m;
}

void Foreground::archive(Archive& a) {
  a& sign_& cell_signal_& own_noise_& frames_& background_.width& background_.height& background_
      .px& covered_;
}

}  // namespace faba
