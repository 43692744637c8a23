#pragma once
#include <filesystem>
#include <string>

#include "core/error.h"

namespace faba {

/// A lock file that one process at a time can hold. The system releases the lock when that process ends for
/// any reason; the file exists until complete().
class FileLock {
 public:
  FileLock() = default;
  /// Creates the file if necessary and writes the process id, the host and, on the next lines, `text`. Throws
  /// Error(held, shown) if another process holds it, Error(internal) if it cannot be written. On a file
  /// system without locks it succeeds: it then only marks the directory.
  FileLock(const std::filesystem::path& file, const std::filesystem::path& shown, const std::string& text,
           Errc held = Errc::usage);
  FileLock(FileLock&& other) noexcept;
  FileLock& operator=(FileLock&& other) noexcept;
  ~FileLock();
  /// Whether any process, including this one, holds the lock of a file. False if the file does not exist.
  static bool held(const std::filesystem::path& file);
  /// Removes the file: the work that it protects is complete.
  void complete();

 private:
  std::filesystem::path file_;
  int descriptor_ = -1;
};

}  // namespace faba
