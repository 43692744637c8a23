#pragma once
#include <cstdint>
#include <filesystem>
#include <functional>
#include <string>

#include "study/data/video_part.h"
#include "vision/files/video_reader.h"

namespace faba {

/// Work on the frames of a part of a video, which may be done in one reading with other work.
struct FrameInspector {
  /// Called with the time of every frame, in order; whether take() needs its picture. May be empty.
  std::function<bool(double t_s)> needs;
  /// Called with such a frame, as the file has it, in order. Returns work on it that any thread may do, or
  /// nothing.
  std::function<std::function<void()>(const GrayF& frame)> take;
  /// Called before the first frame. May be empty.
  std::function<void(const VideoReader& video)> begin = {};
};

/// Both of them in one reading. Either may be empty.
FrameInspector both(const FrameInspector& a, const FrameInspector& b);

/// What a complete reading of a part of a video has found.
struct VideoReading {
  int bits = 8;          ///< see VideoReader
  bool timed = true;     ///< whether the file states a frame rate, or one was given
  bool damaged = false;  ///< frames are missing
  std::string damage;    ///< see VideoReader
};

/// Reads a part of a video for an inspector alone. `tick` is called after each frame with the number of
/// frames of the part, and that stated in the file (0: unknown). `threads`: 0: all.
VideoReading inspect_video(const std::filesystem::path& video, const VideoPart& part,
                           const FrameInspector& inspector, unsigned threads,
                           const std::function<void(std::int64_t done, std::int64_t stated)>& tick);

/// The number of frames of a part of a video as stated in the file; 0: unknown.
std::int64_t frames_stated(const VideoReader& video, const VideoPart& part);

}  // namespace faba
