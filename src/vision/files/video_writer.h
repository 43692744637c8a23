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
/// During recording, `part` is a raw stream of encoded frames (H.264 Annex B, or concatenated PNG files) that
/// is valid and playable after every write(). finish() remuxes these frames into the final container. To
/// resume after a crash, construct the writer again with the byte count returned by the last sync(): the file
/// is truncated to that length. Every sync() resets the encoder, so an interrupted and resumed run gives the
/// same bytes as an uninterrupted one if both call sync() after the same frames. The bytes do not depend on
/// the processor.
///
/// Grey values (r = g = b) are stored exactly in lossless_avi, and up to coding noise in mp4 (tagged full
/// range). In mp4 an odd width or height is made even by repeating the last column or row; players show this
/// size.
class VideoWriter {
 public:
  /// `width`, `height`: px, 1 to 16384; `fps`: frames per second, > 0, rounded by frame_rate_near(). An
  /// existing `part` is replaced, or with `resume_at_bytes` > 0 truncated to that length and continued.
  /// Throws Error(Errc::input, part) when `part` does not exist or is shorter than that,
  /// Error(Errc::internal) when it cannot be written or this FFmpeg does not have the encoder. `pixels` is
  /// the only pixel type that write() accepts.
  VideoWriter(const std::filesystem::path& part, VideoFormat format, int width, int height, double fps,
              std::uint64_t resume_at_bytes = 0, VideoPixels pixels = VideoPixels::colour);
  /// Closes `part` and keeps it: only finish() removes it.
  ~VideoWriter();
  VideoWriter(VideoWriter&&) noexcept;
  VideoWriter& operator=(VideoWriter&&) noexcept;

  /// Encodes and appends one frame. Throws Error(Errc::internal, part) on a full disk; `part` then ends with
  /// the previous frame, and the frame can be written again when there is space.
  void write(const RgbImage& frame);
  void write(const Gray8& frame);                 ///< For VideoPixels::grey8.
  void write(const Image<std::uint16_t>& frame);  ///< For VideoPixels::grey16.

  /// The next frame is encoded as by a new writer: a key frame that does not depend on the frames before it.
  void restart();

  /// Syncs all frames to disk and returns the length in bytes at which to resume. Calls
  /// restart(). Throws Error(Errc::internal, part).
  std::uint64_t sync();

  /// Writes `final_path` (through `final_path` + ".tmp"), replacing an existing file, and removes `part`
  /// unless `keep_part` is set; a kept part can be resumed at the last sync(). Nothing can be written
  /// afterwards. Throws Error(Errc::internal) when no frame was written or the disk is full; `part` is then
  /// kept and finish() may be called again.
  ///
  /// `time_s`, if given, is the time of each frame, s, increasing, 0 for frame 0: an mp4 then stores these
  /// times to the microsecond, and VideoReader returns them. AVI supports a constant rate only: lossless_avi
  /// keeps the rate given to the constructor.
  void finish(const std::filesystem::path& final_path, bool keep_part = false,
              const std::function<double(long long frame)>& time_s = {});

 private:
  template <class Pixel>
  void append(const Image<Pixel>& frame);
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

}  // namespace faba
