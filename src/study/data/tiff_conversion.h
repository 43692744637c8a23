#pragma once
#include <filesystem>
#include <functional>
#include <string>
#include <vector>

#include "study/data/video_part.h"
#include "study/data/video_scale.h"
#include "vision/files/tiff_export.h"

namespace faba {

/// A video that is converted to a TIFF stack.
struct TiffConversion {
  std::filesystem::path video;  ///< anything VideoReader reads, or a run directory
  std::filesystem::path out;    ///< its name selects the metadata, see tiff_kind()
  VideoScale scale;             ///< given by the user; overrides that of the run or file
  VideoPart part;
  unsigned threads = 0;  ///< 0: all; they do not change the result
  /// See TiffExport.
  std::function<bool(std::int64_t done, std::int64_t total)> progress;
};

struct ConvertedTiff {
  TiffKind kind = TiffKind::ome;
  int width = 0, height = 0;  ///< px
  VideoScale scale;
  TiffExported stack;
  std::vector<std::string> notes;
};

/// Throws as video_or_drawing(), VideoReader and export_tiff().
ConvertedTiff convert_to_tiff(const TiffConversion& job);

}  // namespace faba
