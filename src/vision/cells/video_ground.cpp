#include "vision/cells/video_ground.h"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <utility>
#include <vector>

#include "core/error.h"
#include "core/random/distributions.h"
#include "core/statistics.h"
#include "core/threads/ordered_work.h"
#include "core/threads/parallel.h"
#include "vision/files/grey_video.h"
#include "vision/foreground/background.h"

namespace faba {
namespace {

constexpr int kMostFrames = 48;
constexpr int kChangeBins = 4096;       // bins of the histogram of changes
constexpr double kFineStep = 1.0 / 16;  // histogram step in grey levels for non-integer grey values
constexpr double kOneSd = 0.6826894921370859;

/// Histogram of the absolute differences between frames, with bins of `step` grey levels.
class Changes {
 public:
  explicit Changes(double step) : step_(step) {}
  void take(const GrayF& before, const GrayF& now) {
    for (std::size_t i = 0; i < now.px.size(); ++i) {
      const float change = std::fabs(now.px[i] - before.px[i]) / float(step_);
      ++count_[std::size_t(std::min(change + 0.5F, float(kChangeBins - 1)))];
    }
  }
  /// Sd of the noise of one frame, grey levels. An integer difference represents the interval of half a step
  /// to each side.
  double sd() const {
    double all = 0, below = 0;
    for (const auto n : count_) all += double(n);
    for (std::size_t k = 0; k < count_.size() && all > 0; ++k) {
      const auto n = double(count_[k]);
      if (below + n >= kOneSd * all) {
        const double from = k == 0 ? 0 : double(k) - 0.5, width = k == 0 ? 0.5 : 1;
        const double change = from + width * (kOneSd * all - below) / n;
        return step_ * std::sqrt(std::max(change * change / 2 - 1.0 / 12, 0.0));
      }
      below += n;
    }
    return 0;
  }

 private:
  double step_;
  std::vector<std::uint64_t> count_ = std::vector<std::uint64_t>(kChangeBins);
};

GrayF quantile_over_time(const std::vector<CompactImage>& frames, double quantile, unsigned threads) {
  constexpr std::size_t kPixelsPerBlock = 4096;
  GrayF out(frames.front().width(), frames.front().height());
  Pool pool(threads);
  pool.for_blocks(out.px.size(), kPixelsPerBlock, [&](std::size_t begin, std::size_t end) {
    const std::size_t n = end - begin;
    std::vector<float> greys(frames.size() * n), values(frames.size());
    for (std::size_t k = 0; k < frames.size(); ++k) frames[k].copy(begin, n, &greys[k * n]);
    for (std::size_t i = begin; i < end; ++i) {
      for (std::size_t k = 0; k < frames.size(); ++k) values[k] = greys[k * n + i - begin];
      out.px[i] = quantile_nearest(values, quantile);
    }
  });
  return out;
}

}  // namespace

VideoBackground read_video_background(const std::filesystem::path& video, const VideoBackgroundOptions& o) {
  constexpr float kWhite = 255;
  const unsigned threads = OrderedWork::threads(o.threads);
  GreyVideo frames(VideoReader(video, o.fps, threads), o.side);
  BackgroundSampler sampler(kMostFrames);
  const bool integer_greys = o.side == 1 && frames.reader().bits() <= 8;
  Changes changes(integer_greys ? 1 : kFineStep);
  GrayF now, before;
  if (o.from_s > 0) frames.skip_to(o.from_s);
  for (double t = 0; frames.read(now, t) && t <= o.to_s; o.tick()) {
    if (t < o.from_s) continue;
    sampler.take(now);
    if (!before.empty()) changes.take(before, now);
    std::swap(now, before);
  }
  if (sampler.kept().empty())
    throw Error(Errc::input, video.string(), "the video has no frames in the requested time range");
  VideoBackground ground{quantile_over_time(sampler.kept(), o.quantile, threads), changes.sd()};
  const auto off = o.quantile == 0.5 ? 0.0F : float(normal_quantile(o.quantile) * ground.noise_sd);
  for (float& grey : ground.light.px) grey = (grey - off) / kWhite;
  ground.noise_sd /= double(kWhite);
  return ground;
}

}  // namespace faba
