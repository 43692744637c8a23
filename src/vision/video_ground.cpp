#include "vision/video_ground.h"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <utility>
#include <vector>

#include "core/error.h"
#include "vision/background.h"
#include "vision/video_reader.h"

namespace faba {
namespace {

constexpr int kMostFrames = 48;
constexpr int kFinest = 4096;  // bins of the histogram of changes
constexpr double kOneSd = 0.6826894921370859;

/// Sizes of the changes from frame to frame, in grey levels.
class Changes {
 public:
  void take(const GrayF& before, const GrayF& now) {
    for (std::size_t i = 0; i < now.px.size(); ++i) {
      const float change = std::fabs(now.px[i] - before.px[i]);
      ++count_[std::size_t(std::min(change + 0.5F, float(kFinest - 1)))];
    }
  }
  /// Sd of the noise of one frame, grey levels. A change of whole levels stands for half a level to each
  /// side.
  double sd() const {
    double all = 0, below = 0;
    for (const auto n : count_) all += double(n);
    for (std::size_t k = 0; k < count_.size() && all > 0; ++k) {
      const auto n = double(count_[k]);
      if (below + n >= kOneSd * all) {
        const double from = k == 0 ? 0 : double(k) - 0.5, width = k == 0 ? 0.5 : 1;
        const double change = from + width * (kOneSd * all - below) / n;
        return std::sqrt(std::max(change * change / 2 - 1.0 / 12, 0.0));
      }
      below += n;
    }
    return 0;
  }

 private:
  std::vector<std::uint64_t> count_ = std::vector<std::uint64_t>(kFinest);
};

}  // namespace

VideoGround read_video_ground(const std::filesystem::path& video) {
  VideoReader reader(video);
  if (reader.bits() > 16)
    throw Error(Errc::input, video.string(),
                "is no background: its grey scale has no white; save it in 8 or 16 bits");
  const auto white = float((1U << reader.bits()) - 1U);
  BackgroundSampler frames(kMostFrames);
  Changes changes;
  GrayF now, before;
  for (double t = 0; reader.read(now, t);) {
    frames.take(now);
    if (!before.empty()) changes.take(before, now);
    std::swap(now, before);
  }
  GrayF light = frames.background().level;
  for (float& grey : light.px) grey /= white;
  return {std::move(light), changes.sd() / double(white)};
}

}  // namespace faba
