#pragma once
#include <cstdint>
#include <vector>

#include "core/archive.h"
#include "vision/image/small_frame.h"

namespace faba {

/// Keeps up to six reduced frames of a video while it is recorded, at equal time intervals from the first to
/// the last, so that the report of the run does not decode the video.
class KeptFrames {
 public:
  static constexpr std::uint64_t kMost = 6;

  /// `frames`: number of frames of the complete video.
  explicit KeptFrames(std::uint64_t frames) : frames_(frames) {}
  /// Whether this frame is one of those that are kept.
  bool keeps(std::uint64_t frame) const;
  void add(SmallFrame frame) { kept_.push_back(std::move(frame)); }
  /// The frames; empty if the video has ended before its last frame.
  std::vector<SmallFrame> frames() const;
  void archive(Archive& a);

 private:
  std::uint64_t frames_;
  std::vector<SmallFrame> kept_;
};

}  // namespace faba
