#pragma once
#include <cstdint>
#include <filesystem>

namespace faba {

/// Size and length of a video, as its header states them.
struct VideoFacts {
  int width = 0, height = 0;  ///< px
  double fps = 0;             ///< 0: not stated
  std::int64_t frames = 0;    ///< 0: not stated
  double duration_s() const { return fps > 0 ? double(frames) / fps : 0; }
};

/// Reads the header and the first frame of a video, a picture or the video of a run directory. Throws
/// Error(input).
VideoFacts video_facts(const std::filesystem::path& path);

}  // namespace faba
