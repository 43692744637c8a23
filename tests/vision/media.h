#pragma once
// Test pictures and temporary folders for the tests of file formats.

#include <unistd.h>

#include <atomic>
#include <cmath>
#include <cstdint>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <string>
#include <system_error>

#include "vision/image/image.h"

namespace faba::media {

/// A temporary folder for one test, removed at the end.
class ScratchFolder {
 public:
  ScratchFolder() {
    static std::atomic<int> count{0};
    path_ = std::filesystem::temp_directory_path() /
            ("faba-media-" + std::to_string(::getpid()) + "-" + std::to_string(count++));
    std::filesystem::create_directories(path_);
  }
  ~ScratchFolder() {
    std::error_code ignored;
    std::filesystem::remove_all(path_, ignored);
  }
  ScratchFolder(const ScratchFolder&) = delete;
  ScratchFolder& operator=(const ScratchFolder&) = delete;
  std::filesystem::path operator/(const std::string& name) const { return path_ / name; }
  const std::filesystem::path& path() const { return path_; }

 private:
  std::filesystem::path path_;
};

inline void write_bytes(const std::filesystem::path& path, const std::string& bytes) {
  std::ofstream(path, std::ios::binary) << bytes;
}

inline std::string read_bytes(const std::filesystem::path& path) {
  std::ifstream file(path, std::ios::binary);
  return {std::istreambuf_iterator<char>(file), {}};
}

/// Test frame: a horizontal grey ramp, a dark disc that moves 2 px right and 1 px down per frame, and with
/// `colour` a red square.
inline RgbImage scene(int width, int height, int frame, bool colour = false) {
  RgbImage picture(width, height);
  for (int row = 0; row < height; ++row) {
    for (int col = 0; col < width; ++col) {
      const double dx = col - (width / 4.0 + 2.0 * frame), dy = row - (height / 3.0 + frame);
      const double ramp = 60 + 150.0 * col / width + 20.0 * row / height;
      const double shade = 1 / (1 + std::exp(std::sqrt(dx * dx + dy * dy) - height / 6.0));
      const auto grey = static_cast<std::uint8_t>(ramp * (1 - 0.7 * shade));
      picture.at(col, row) = {grey, grey, grey};
      if (colour && col < width / 5 && row > 2 * height / 3) picture.at(col, row) = {220, 30, 60};
    }
  }
  return picture;
}

}  // namespace faba::media
