#pragma once
#include <filesystem>

namespace faba {

/// Reader for a picture or video file.
enum class InputKind {
  tiff,    ///< starts with a TIFF or BigTIFF signature
  stream,  ///< any other content; libavformat detects the format
};

/// Selects the reader by the first bytes of a file. Throws Error(Errc::input, path) when `path` does not
/// exist, is a directory, is not a regular file, is empty, or cannot be opened.
InputKind check_input_file(const std::filesystem::path& path);

}  // namespace faba
