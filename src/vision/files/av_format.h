#pragma once
#include <filesystem>
#include <string_view>

struct AVInputFormat;
struct AVIOContext;

namespace faba {

/// Whether a format of libavformat is refused: formats that it accepts for arbitrary bytes (text art, raw
/// data), and formats that refer to other files.
bool is_refused_format(std::string_view kind);

/// Whether a format of libavformat is that of a still image.
bool is_still(std::string_view kind);

/// Whether the header of an AVI file states more bytes than the file has; libavformat does not compare them.
bool is_avi_truncated(const std::filesystem::path& path);

/// Whether a JPEG file has no end marker, which the decoder pads.
bool is_jpeg_truncated(const std::filesystem::path& path);

/// The format of a PGM or PPM file, else null. FFmpeg decodes them with any white space in the header, but
/// detects only headers with one field per line.
const AVInputFormat* portable_map(AVIOContext& io);

}  // namespace faba
