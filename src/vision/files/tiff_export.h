#pragma once
#include <cstdint>
#include <filesystem>
#include <functional>
#include <optional>
#include <string>

#include "vision/files/tiff/tiff_writer.h"
#include "vision/files/video_reader.h"

namespace faba {

/// A video that is written as a TIFF stack.
struct TiffExport {
  std::filesystem::path out;        ///< its name selects the metadata, see tiff_kind()
  std::optional<double> um_per_px;  ///< empty: not known
  double from_s = 0;                ///< s of the video
  std::optional<double> to_s = {};  ///< empty: to the end
  bool colour = false;              ///< 8 bits per colour; else grey, with the values of the video
  /// Called before every frame with the number of frames done and the total (0: unknown). If it returns
  /// false, the export ends with Error(interrupted), and no file is written.
  std::function<bool(std::int64_t done, std::int64_t total)> progress = {};
};

/// What was written.
struct TiffExported {
  std::uint64_t frames = 0;
  TiffPixels pixels = TiffPixels::grey8;
  std::optional<double> frame_s;  ///< see FrameInterval; empty: the video states no times
  bool regular = true;            ///< frames are at equal times
  bool big = false;               ///< a BigTIFF, because it exceeds 4 GB
  std::string damage;             ///< of the video, whose damaged frames are missing; empty: none
};

/// Writes the frames of a video as a TIFF stack with scale and frame interval. Grey values of 8 and 16 bits
/// are kept, others are written as 32-bit floats. Throws Error(input) if no frame is in the part, and for
/// values that the type does not hold; Error(internal) if the file cannot be written.
TiffExported export_tiff(VideoReader& video, const TiffExport& job);

}  // namespace faba
