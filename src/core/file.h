#pragma once
#include <cstdint>
#include <filesystem>
#include <span>
#include <string>
#include <string_view>

namespace faba {

/// Writes the whole content under a temporary name, syncs, and renames: the name never stands for a part.
/// Throws Error(internal) with the reason (full disk, no permission); then nothing is left behind and an old
/// file is intact.
void write_file(const std::filesystem::path& file, std::string_view content);

/// The whole content. Throws Error(input) when missing, a directory or unreadable.
std::string read_file(const std::filesystem::path& file);

/// A file that grows by whole pieces (a line, a frame), written straight through so that a crash of the
/// program loses nothing that append() has taken. Every failure throws Error(Errc::internal, path) with the
/// system's reason.
class OutputFile {
 public:
  /// Creates `path`, or replaces what is there. With `keep_bytes` > 0 the file must exist with at least that
  /// many bytes, else Error(Errc::input); it is truncated to them and continued. Messages name `shown` when
  /// it is given.
  explicit OutputFile(const std::filesystem::path& path, std::uint64_t keep_bytes = 0,
                      const std::filesystem::path& shown = {});
  ~OutputFile();
  OutputFile(const OutputFile&) = delete;
  OutputFile& operator=(const OutputFile&) = delete;

  /// Appends all of `piece` or, when that fails (disk full), throws with the file cut back to what it was.
  void append(std::span<const std::uint8_t> piece);
  void append(std::string_view piece);
  /// Returns when everything appended so far is on the disk.
  void sync();
  /// Closes the file; only sync() promises that it is on the disk. Closing twice is allowed.
  void close();

  std::uint64_t size() const { return size_; }                 ///< bytes
  const std::filesystem::path& path() const { return path_; }  ///< as given

 private:
  [[noreturn]] void fail(const char* what_failed, int error_number) const;

  std::filesystem::path path_, shown_;
  int descriptor_ = -1;
  std::uint64_t size_ = 0;
};

/// Returns when all that was written to an open file is on the disk. Throws Error(Errc::internal, shown).
void flush_descriptor(int descriptor, const std::filesystem::path& shown);

/// Gives the complete file `from` its final name in the same file system, replacing what is there, and makes
/// sure that content and name outlive a power cut. Throws Error(Errc::internal, to).
void rename_complete(const std::filesystem::path& from, const std::filesystem::path& to);

/// What a file is called until it is complete and renamed: `path` + ".tmp".
std::filesystem::path temporary_name(const std::filesystem::path& path);

}  // namespace faba
