#pragma once
#include <filesystem>

namespace faba {

// What a file can be by its extension, in any case. A TIFF file can be a picture or a stack of frames.
bool has_video_extension(const std::filesystem::path& file);
bool has_picture_extension(const std::filesystem::path& file);
bool has_table_extension(const std::filesystem::path& file);

}  // namespace faba
