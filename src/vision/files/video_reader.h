#pragma once
#include <cstdint>
#include <filesystem>
#include <memory>
#include <string>

#include "vision/image/image.h"

namespace faba {

/// Reads the frames of a video in order as grey pictures. Input: a video that FFmpeg supports, a TIFF stack,
/// a still image (one frame), or a picture sequence: a folder or a pattern such as `frames/frame_*.tif` or
/// `frames/frame_%04d.tif` (see PictureSequence for order and times). The memory use does not depend on the
/// length. Not thread-safe; several readers can be used in parallel.
///
/// Grey: see to_grey() in frame_grey.h (luma; studio range is stretched to 0..255 or 0..65535) and TiffStack.
/// The luma of a colour video follows the colour matrix of the file. Rotation tags and non-square pixels are
/// ignored: pixels are in storage order.
///
/// Damage: a frame that cannot be decoded completely is skipped, as are all frames predicted from it; reading
/// continues at the next key frame; there is no error concealment. All complete frames of a truncated file
/// are read, then read() returns false and truncated() is true. Limits: transport streams, raw H.264 and GIF
/// do not store their length, so truncation between two frames is not detected; in streams with B-frames, a
/// few frames displayed just before a damaged frame may have been predicted from it.
class VideoReader {
 public:
  /// Opens the file and decodes its first frame. `fps` > 0 overrides the mean frame rate of the file (time
  /// stamps are scaled); 0: frame rate of the file. `threads` decode, where the format permits it; they do
  /// not change the result. Throws Error(Errc::input, path) when the file does not exist, is a directory
  /// without pictures, is empty, has an unknown format or no video stream, or when no frame can be decoded.
  explicit VideoReader(const std::filesystem::path& path, double fps = 0, unsigned threads = 1);
  ~VideoReader();
  VideoReader(VideoReader&&) noexcept;
  VideoReader& operator=(VideoReader&&) noexcept;

  int width() const;   ///< px
  int height() const;  ///< px
  /// Bit depth of the grey scale: white is 2^bits - 1 (8 or 16; for TIFF see TiffStack::bits).
  int bits() const;
  /// Mean frames per second, as given or from the file; 0 when unknown (still images, TIFF files without a
  /// frame interval in their metadata, see PictureMetadata).
  double fps() const;
  /// Number of frames according to the file header, for progress bars only; 0 when unknown.
  std::int64_t frames_in_header() const;

  /// Skips frames without decoding them, for readers that need no frame before the time `t_s`: the next frame
  /// is the last key frame not after `t_s`. Returns the number of skipped frames; 0 if there is no such key
  /// frame ahead, and for TIFF stacks and picture sequences. Damage in skipped frames is not detected.
  std::int64_t skip_to(double t_s);

  /// Goes to another part of the video, for display: read() then returns the frame displayed at `t_s`, or
  /// frames before it first (from a key frame). Some formats may start after `t_s`; seek to an earlier time
  /// then. Returns false without an effect when the file has no time stamps or several threads decode; open
  /// it again then. Damage in skipped frames is not detected, and damaged frames that are read twice count
  /// twice.
  bool seek(double t_s);

  /// Reads the next frame into `frame` (resized as needed) and its presentation time in s. The first frame
  /// has time 0; times come from the time stamps of the file, so variable frame rates are supported. Without
  /// time stamps t_s is frame / fps(), or the frame index when fps() is 0. Returns false after the last
  /// frame. Throws Error(Errc::input, path) when the picture size or pixel format changes within the file.
  bool read(GrayF& frame, double& t_s);

  /// read() in two steps, for readers that do not need every picture: next() advances to the next frame and
  /// decodes it; picture() converts it, and may be called several times.
  bool next(double& t_s);
  void picture(GrayF& frame);

  /// As read(), in 8-bit RGB for display; grey when the file has no colours.
  bool read_colours(RgbImage& frame, double& t_s);

  /// Whether the file is truncated; final after read() has returned false.
  bool truncated() const;
  /// Number of frames (packets) skipped so far because of damage; 0 for an intact file.
  std::int64_t damaged_frames() const;
  /// Description of the first error in one line; empty if there was none.
  const std::string& damage() const;

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

}  // namespace faba
