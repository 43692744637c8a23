#pragma once
#include <chrono>
#include <filesystem>

namespace faba {

/// Time of the last change of a file, s since 1970.
inline double modified_s(const std::filesystem::path& file) {
  const auto time = std::chrono::file_clock::to_sys(std::filesystem::last_write_time(file));
  return std::chrono::duration<double>(time.time_since_epoch()).count();
}

}  // namespace faba
