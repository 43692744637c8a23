#pragma once
#include <filesystem>
#include <optional>
#include <string>

namespace faba {

/// Scale of a video or picture.
struct VideoScale {
  std::optional<double> um_per_px;  ///< empty: not known
  std::string source;   ///< "calibration", "ruler", "typed" or "metadata"; empty: that of a simulated camera
  std::string ignored;  ///< note on metadata that were ignored; empty: none
  std::optional<double> standard_error = {};  ///< of um_per_px; empty: not known
};

/// The scale in the metadata of a file (see PictureMetadata).
VideoScale scale_of_file(const std::filesystem::path& file);

}  // namespace faba
