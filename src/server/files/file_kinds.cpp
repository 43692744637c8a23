#include "server/files/file_kinds.h"

#include <algorithm>
#include <cctype>
#include <initializer_list>
#include <string>
#include <string_view>

namespace faba {
namespace {

bool is_one_of(const std::filesystem::path& file, std::initializer_list<std::string_view> extensions) {
  std::string extension = file.extension().string();
  std::transform(extension.begin(), extension.end(), extension.begin(),
                 [](unsigned char c) { return char(std::tolower(c)); });
  return std::ranges::find(extensions, extension) != extensions.end();
}

}  // namespace

bool has_video_extension(const std::filesystem::path& file) {
  return is_one_of(file, {".mp4", ".avi", ".mkv", ".mov", ".webm", ".mpg", ".tif", ".tiff"});
}

bool has_picture_extension(const std::filesystem::path& file) {
  return is_one_of(file, {".png", ".jpg", ".jpeg", ".pgm", ".ppm", ".bmp", ".tif", ".tiff"});
}

bool has_table_extension(const std::filesystem::path& file) {
  return is_one_of(file, {".csv", ".txt", ".dat", ".h5", ".hdf5"});
}

}  // namespace faba
