#pragma once
#include <filesystem>

#include "vision/files/tiff/tiff_description.h"

namespace faba {

/// The metadata of a picture or video as VideoReader reads it: of a TIFF file, or of the first file of a
/// picture sequence; the frame rate of a folder also from the file times.csv that `faba rig capture` writes.
/// Nothing for other formats, whose resolution is that of a print. Does not throw: a file
/// that cannot be read has no metadata.
PictureMetadata picture_metadata(const std::filesystem::path& path);

}  // namespace faba
