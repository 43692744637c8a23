#include "vision/foreground/background.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <utility>

#include "core/error.h"
#include "core/statistics.h"
#include "vision/foreground/kernels/temporal_median.h"
#include "vision/image/kernels/smoothing.h"

namespace faba {
namespace {

constexpr float kMinNoise = 0.25F;  // grey steps; quantisation noise is 1 / sqrt(12)
constexpr int kMinFrames = 5;
constexpr std::size_t kPixelsPerBlock = 4096;
constexpr double kNoiseSmoothing = 3;  // px
constexpr std::size_t kMostNoiseSteps = 250'000;

// Standard deviation of the values within three robust ones; integer grey steps make the robust estimate
// coarse.
float fine_spread(const std::vector<float>& values) {
  constexpr double kTruncatedNormalSd = 0.98658;  // sd of a normal distribution truncated at three sd
  std::vector<float> work = values;
  const RobustSpread<float> rough = robust_spread_low(work);
  double n = 0, sum = 0, squares = 0;
  for (const float v : values) {
    const double d = double(v) - double(rough.median);
    if (std::fabs(d) > 3 * double(rough.sd)) continue;
    n += 1;
    sum += d;
    squares += d * d;
  }
  return n > 1 ? float(std::sqrt(std::max(0.0, squares / n - sum * sum / (n * n))) / kTruncatedNormalSd)
               : 0.0F;
}

}  // namespace

BackgroundSampler::BackgroundSampler(int most_frames, std::size_t most_bytes)
    : most_frames_(std::max(1, most_frames)), most_bytes_(most_bytes) {}

std::size_t BackgroundSampler::most_kept(std::size_t pixels) const {
  const auto fit = most_bytes_ / std::max<std::size_t>(1, pixels * sizeof(float));
  return std::clamp<std::size_t>(fit, std::size_t(std::min(kMinFrames, most_frames_)),
                                 std::size_t(most_frames_));
}

std::uint64_t BackgroundSampler::stride_for(std::uint64_t frames, std::size_t pixels) const {
  std::uint64_t stride = 1;
  while ((frames + stride - 1) / stride > most_kept(pixels)) stride *= 2;
  return stride;
}

void BackgroundSampler::take(const GrayF& frame) {
  if (!kept_.empty() && (frame.width != kept_[0].width() || frame.height != kept_[0].height()))
    throw Error(Errc::internal, "", "the frame differs in size from the previous frames of the background");
  const bool wanted = needs_next();
  ++seen_;
  if (!wanted) return;
  if (kept_.size() >= most_kept(frame.px.size())) {
    std::size_t to = 0;
    for (std::size_t from = 0; from < kept_.size(); from += 2) std::swap(kept_[to++], kept_[from]);
    while (kept_.size() > to) {
      dropped_.push_back(std::move(kept_.back()));
      kept_.pop_back();
    }
    stride_ *= 2;
    if ((seen_ - 1) % stride_ != 0) return;
  }
  if (dropped_.empty()) {
    kept_.emplace_back(frame);
    return;
  }
  kept_.push_back(std::move(dropped_.back()));
  dropped_.pop_back();
  kept_.back().assign(frame);
}

Background BackgroundSampler::background() const {
  Pool one_thread(1);
  return background(one_thread);
}

Background BackgroundSampler::background(Pool& pool) const {
  Background b;
  if (kept_.empty()) return b;
  const int w = kept_[0].width(), h = kept_[0].height();
  b.level = b.noise_sd = GrayF(w, h);
  b.frames = int(kept_.size());
  const std::size_t pixels = b.level.px.size();
  pool.run_uneven((pixels + kPixelsPerBlock - 1) / kPixelsPerBlock, [&](std::size_t block) {
    const std::size_t begin = block * kPixelsPerBlock, end = std::min(pixels, begin + kPixelsPerBlock);
    temporal_medians(kept_, begin, end, b.level, b.noise_sd);
    for (std::size_t i = begin; i < end; ++i) b.noise_sd.px[i] *= float(kMadToSd);
  });
  b.noise_sd = smoothed(b.noise_sd, kNoiseSmoothing);
  for (float& v : b.noise_sd.px) v = std::max(v, kMinNoise);
  return b;
}

Background spatial_background(const GrayF& frame, double sd_px) {
  Background b;
  b.level = smoothed_broadly(frame, sd_px);
  b.frames = 1;
  // A sample of the rows of a large frame is sufficient: the estimate has an error of 0.2 %.
  const int every = 1 + int(frame.px.size() / kMostNoiseSteps);
  std::vector<float> steps;
  steps.reserve(std::min(frame.px.size(), kMostNoiseSteps));
  for (int row = 0; row < frame.height; row += every)
    for (int col = 0; col + 1 < frame.width; ++col)
      steps.push_back(frame.at(col + 1, row) - frame.at(col, row));
  const float sd = steps.empty() ? 0 : fine_spread(steps) / std::sqrt(2.0F);
  b.noise_sd = GrayF(frame.width, frame.height, std::max(sd, kMinNoise));
  return b;
}

Polarity polarity_of(const std::vector<float>& differences) {
  if (differences.empty()) return Polarity::dark;
  std::vector<float> work = differences;
  const RobustSpread<float> s = robust_spread_low(work);
  double third = 0;
  for (const float d : differences) {
    const double z = double(d) - double(s.median);
    if (std::fabs(z) > 3 * double(s.sd)) third += z * z * z;
  }
  return third > 0 ? Polarity::bright : Polarity::dark;
}

}  // namespace faba
