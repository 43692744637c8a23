#include "vision/video_ground.h"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <vector>

#include "core/error.h"
#include "vision/video_reader.h"

namespace faba {
namespace {

constexpr std::size_t kMostFrames = 48;
constexpr int kFinest = 4096;  // bins of the histogram of changes
constexpr double kOneSd = 0.6826894921370859;

/// Frames evenly spread over a video of unknown length.
class Spread {
 public:
  void take(const GrayF& frame) {
    if (count_++ % stride_ != 0) return;
    if (kept_.size() == kMostFrames) {
      for (std::size_t i = 1; 2 * i < kept_.size(); ++i) kept_[i] = std::move(kept_[2 * i]);
      kept_.resize(kMostFrames / 2);
      stride_ *= 2;
      if ((count_ - 1) % stride_ != 0) return;
    }
    std::vector<std::uint16_t>& grey = kept_.emplace_back(frame.px.size());
    for (std::size_t i = 0; i < grey.size(); ++i)
      grey[i] = std::uint16_t(std::clamp(frame.px[i], 0.0F, 65535.0F) + 0.5F);
  }
  GrayF median(int width, int height, float white) const {
    GrayF m(width, height);
    std::vector<std::uint16_t> v(kept_.size());
    const std::size_t middle = v.size() / 2;
    for (std::size_t i = 0; i < m.px.size(); ++i) {
      for (std::size_t k = 0; k < v.size(); ++k) v[k] = kept_[k][i];
      std::nth_element(v.begin(), v.begin() + std::ptrdiff_t(middle), v.end());
      float grey = float(v[middle]);
      if (v.size() % 2 == 0)
        grey = 0.5F * (grey + float(*std::max_element(v.begin(), v.begin() + std::ptrdiff_t(middle))));
      m.px[i] = grey / white;
    }
    return m;
  }

 private:
  std::vector<std::vector<std::uint16_t>> kept_;
  std::size_t count_ = 0, stride_ = 1;
};

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
  Spread spread;
  Changes changes;
  GrayF now, before;
  for (double t = 0; reader.read(now, t);) {
    spread.take(now);
    if (!before.empty()) changes.take(before, now);
    std::swap(now, before);
  }
  return {spread.median(reader.width(), reader.height(), white), changes.sd() / double(white)};
}

}  // namespace faba
