#include "vision/video_ground.h"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <utility>
#include <vector>

#include "vision/background.h"
#include "vision/grey_video.h"

namespace faba {
namespace {

constexpr int kMostFrames = 48;
constexpr int kFinest = 4096;       // bins of the histogram of changes
constexpr double kFine = 1.0 / 16;  // of a level, where greys are not whole ones
constexpr double kOneSd = 0.6826894921370859;

/// Sizes of the changes from frame to frame, in grey levels, sorted by steps of `step` levels.
class Changes {
 public:
  explicit Changes(double step) : step_(step) {}
  void take(const GrayF& before, const GrayF& now) {
    for (std::size_t i = 0; i < now.px.size(); ++i) {
      const float change = std::fabs(now.px[i] - before.px[i]) / float(step_);
      ++count_[std::size_t(std::min(change + 0.5F, float(kFinest - 1)))];
    }
  }
  /// Sd of the noise of one frame, grey levels. A change of whole steps stands for half a step to each side.
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
  std::vector<std::uint64_t> count_ = std::vector<std::uint64_t>(kFinest);
};

}  // namespace

VideoGround read_video_ground(const std::filesystem::path& video, int side,
                              const std::function<void()>& tick) {
  constexpr float kWhite = 255;
  GreyVideo frames(video, 0, side);
  BackgroundSampler sampler(kMostFrames);
  const bool whole = side == 1 && frames.reader().bits() <= 8;
  Changes changes(whole ? 1 : kFine);
  GrayF now, before;
  for (double t = 0; frames.read(now, t);) {
    sampler.take(now);
    if (!before.empty()) changes.take(before, now);
    std::swap(now, before);
    tick();
  }
  GrayF light = sampler.background().level;
  for (float& grey : light.px) grey /= kWhite;
  return {std::move(light), changes.sd() / double(kWhite)};
}

}  // namespace faba
