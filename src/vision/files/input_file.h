#pragma once
#include <filesystem>

namespace faba {

/// What a picture or video file is read with.
enum class InputKind {
  tiff,    ///< begins with a TIFF or BigTIFF signature, whatever its name
  stream,  ///< anything else: a picture or video for libavformat to recognise
};

/// Looks at the first bytes of a picture or video file. Throws Error(Errc::input, path) when `path` is
/// missing, a directory, not a regular file, empty, or may not be read.
InputKind check_input_file(const std::filesystem::path& path);

}  // namespace faba
