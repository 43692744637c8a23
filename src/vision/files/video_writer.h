#pragma once
#include <cstdint>
#include <filesystem>
#include <functional>
#include <memory>

#include "vision/files/video_format.h"
#include "vision/image/image.h"

namespace faba {

/// Records frames so that a crash loses at most the frame being written.
///
/// While it grows, the recording is a plain stream of coded frames in `part` (H.264 Annex B, or PNG files one
/// after the other), valid after every write() and playable as it is. finish() puts the same coded frames
/// into the final container. To go on after a crash, construct again with the byte count that the last sync()
/// returned: the file is cut there. Every sync() starts the coder afresh, so that a run that was broken off
/// and continued gives the same bytes as one that was not, provided that both call sync() after the same
/// frames. Same frames, same syncs: same bytes, on any processor.
///
/// Greys (r = g = b) keep their value: exactly in lossless_avi, to coding noise in mp4, where the range is
/// tagged full. In mp4 an odd width or height is made even by repeating the last column or row, and that is
/// the size players show.
class VideoWriter {
 public:
  /// `width`, `height` in px, 1 to 16384; `fps` > 0 in frames per second, taken as frame_rate_near() says. An
  /// existing `part` is replaced, or with `resume_at_bytes` > 0 cut to that length and continued. Throws
  /// Error(Errc::input, part) when it is missing or shorter than that, Error(Errc::internal) when it cannot
  /// be written or this FFmpeg lacks the encoder. Only pictures of the kind `pixels` can be written.
  VideoWriter(const std::filesystem::path& part, VideoFormat format, int width, int height, double fps,
              std::uint64_t resume_at_bytes = 0, VideoPixels pixels = VideoPixels::colour);
  /// Closes `part` and keeps it: only finish() removes it.
  ~VideoWriter();
  VideoWriter(VideoWriter&&) noexcept;
  VideoWriter& operator=(VideoWriter&&) noexcept;

  /// Codes and appends one frame. Throws Error(Errc::internal, part) on a full disk; `part` then ends with
  /// the frame before, and the same frame may be written again once there is room.
  void write(const RgbImage& frame);
  void write(const Gray8& frame);                 ///< The same for VideoPixels::grey8.
  void write(const Image<std::uint16_t>& frame);  ///< The same for VideoPixels::grey16.

  /// Makes sure that every frame so far is on the disk, and returns the length in bytes to resume at. The
  /// next frame is a key frame. Throws Error(Errc::internal, part).
  std::uint64_t sync();

  /// Writes `final_path` (by way of `final_path` + ".tmp"), replacing what is there, and removes `part`,
  /// unless `keep_part` is set: then it stays, to go on later where the last sync() ended. Nothing can be
  /// written afterwards. Throws Error(Errc::internal) when no frame was written or the disk is full; `part`
  /// is then kept and finish() may be called again.
  ///
  /// `time_s`, when given, says at what time each frame was taken, s, rising, 0 for frame 0: an mp4 then
  /// carries these times, to the microsecond, which VideoReader reads back. AVI knows a constant rate only:
  /// lossless_avi keeps the rate given above.
  void finish(const std::filesystem::path& final_path, bool keep_part = false,
              const std::function<double(long long frame)>& time_s = {});

 private:
  template <class Pixel>
  void append(const Image<Pixel>& frame);
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

}  // namespace faba
