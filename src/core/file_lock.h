#pragma once
#include <filesystem>
#include <string>

namespace faba {

/// A file that one process at a time can hold. The system takes the lock back however that process ends; the
/// file stays until complete().
class FileLock {
 public:
  FileLock() = default;
  /// Makes the file if it is not there; it then holds the process's number and, below, `text`. Throws
  /// Error(usage, shown) when another process holds it, Error(internal) when it cannot be written.
  FileLock(const std::filesystem::path& file, const std::filesystem::path& shown, const std::string& text);
  FileLock(FileLock&& other) noexcept;
  FileLock& operator=(FileLock&& other) noexcept;
  ~FileLock();
  /// Removes the file: what it stood for is whole.
  void complete();

 private:
  std::filesystem::path file_;
  int descriptor_ = -1;
};

}  // namespace faba
