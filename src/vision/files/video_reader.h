#pragma once
#include <cstdint>
#include <filesystem>
#include <memory>
#include <string>

#include "vision/image/image.h"

namespace faba {

/// Reads the frames of a video one after the other as grey pictures: any video FFmpeg reads, a TIFF stack, a
/// still picture (one frame), or many pictures: a folder of them or a pattern such as `frames/frame_*.tif`
/// and `frames/frame_%04d.tif` (see PictureSequence for their order and times). Memory does not grow with the
/// length. Not to be shared between threads; several readers may work at the same time.
///
/// Grey: see to_grey() in frame_grey.h (luma as it is, studio range spread to 0..255 or 0..65535) and
/// TiffStack. Luma of coloured material weighs the colours as the video's own matrix says. Rotation tags and
/// non-square pixels are not applied: pixels come as stored.
///
/// Damage: a frame that cannot be decoded whole is not returned, nor are the frames predicted from it;
/// reading goes on at the next key frame, so that no pixel is guessed. What a file cut short still holds is
/// read, then read() gives false and truncated() is true. Limits: transport streams, bare H.264 and GIF do
/// not say how long they should be, so a cut between two of their frames goes unnoticed; in streams with
/// B-frames up to a few frames shown just before one that is damaged inside may have been predicted from it.
class VideoReader {
 public:
  /// Opens the file and decodes its first frame. `fps` > 0: the mean frame rate, whatever the
  /// file states (its time stamps are scaled); 0: as the file states. Throws Error(Errc::input, path) when it
  /// is missing, a directory without pictures, empty, of no known kind, without a picture stream, or when not
  /// even one frame can be decoded.
  explicit VideoReader(const std::filesystem::path& path, double fps = 0);
  ~VideoReader();
  VideoReader(VideoReader&&) noexcept;
  VideoReader& operator=(VideoReader&&) noexcept;

  int width() const;   ///< px
  int height() const;  ///< px
  /// Bits of the grey scale: white is 2^bits - 1 (8 or 16; for TIFF see TiffStack::bits).
  int bits() const;
  /// Mean frames per second as given or as the file states it; 0 when it states none (TIFF without ImageJ's
  /// text, still pictures, folders of pictures).
  double fps() const;
  /// Number of frames as the file states it, good for a progress bar only; 0 when not stated.
  std::int64_t frames_stated() const;

  /// The next frame into `frame` (resized as needed) and its presentation time in s, 0 at the first frame,
  /// from the time stamps of the file, so that variable frame rates come out right. Without time stamps t_s
  /// is frame / fps(), and where fps() is 0 it is the number of the frame. False when no frame is left.
  /// Throws Error(Errc::input, path) when the picture size or format changes on the way.
  bool read(GrayF& frame, double& t_s);

  /// The same in colours of 8 bits, for the eye; grey where the file has none.
  bool read_colours(RgbImage& frame, double& t_s);

  /// Whether the file ended before it should; final once read() has given false.
  bool truncated() const;
  /// Frames (packets) skipped so far because they were damaged; 0 for an intact file.
  std::int64_t damaged_frames() const;
  /// The first trouble met in one line, empty when there was none: the reason behind the two above.
  const std::string& damage() const;

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

}  // namespace faba
