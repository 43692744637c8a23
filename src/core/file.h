#pragma once
#include <cstdint>
#include <filesystem>
#include <string>
#include <string_view>
#include <vector>

namespace faba {

/// Writes the whole content under a temporary name, syncs, and renames: the name never stands for a part.
/// Throws Error(internal) with the reason (full disk, no permission); then nothing is left behind and an old
/// file is intact.
void write_file(const std::filesystem::path& file, std::string_view content);

/// The whole content. Throws Error(input) when missing, a directory or unreadable.
std::string read_file(const std::filesystem::path& file);

/// A file that grows line by line or block by block and may be cut back to where a checkpoint left it.
class AppendFile {
 public:
  /// Opens for writing; an existing file is cut to `keep_bytes` first. Throws Error(internal), or
  /// Error(input) when the file is shorter than `keep_bytes`.
  AppendFile(std::filesystem::path file, std::uint64_t keep_bytes);
  ~AppendFile();
  AppendFile(const AppendFile&) = delete;
  AppendFile& operator=(const AppendFile&) = delete;

  void write(std::string_view bytes);  ///< buffered
  std::uint64_t sync();                ///< to the disk; returns the length
  void close();                        ///< sync and close; write() may not follow

 private:
  void flush();
  std::filesystem::path path_;
  int fd_ = -1;
  std::string buffer_;
  std::uint64_t length_ = 0;
};

}  // namespace faba
