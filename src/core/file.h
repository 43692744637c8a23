#pragma once
#include <cstdint>
#include <filesystem>
#include <initializer_list>
#include <span>
#include <string>
#include <string_view>

namespace faba {

/// Writes `content` to a temporary file, syncs it, and renames it, so that `file` never has partial content.
/// Throws Error(internal) with the reason (full disk, no permission); the temporary file is then removed and
/// an existing file is unchanged.
void write_file(const std::filesystem::path& file, std::string_view content);
/// The same for content in several pieces.
void write_file(const std::filesystem::path& file, std::initializer_list<std::string_view> pieces);

/// Content of a file. Throws Error(input) if it is missing, a directory or unreadable.
std::string read_file(const std::filesystem::path& file);

/// A file to which complete records (a line, a frame) are appended. Writes are unbuffered, so that a crash of
/// the program loses no appended record. Every failure throws Error(Errc::internal, path) with the system's
/// reason.
class OutputFile {
 public:
  /// Creates or replaces `path`. With `keep_bytes` > 0 the file must exist with at least that many bytes,
  /// otherwise throws Error(Errc::input); it is truncated to them and continued. Messages show `shown` unless
  /// it is empty.
  explicit OutputFile(const std::filesystem::path& path, std::uint64_t keep_bytes = 0,
                      const std::filesystem::path& shown = {});
  ~OutputFile();
  OutputFile(const OutputFile&) = delete;
  OutputFile& operator=(const OutputFile&) = delete;

  /// Appends `piece`. If that fails (disk full), truncates the file to its previous size and throws.
  void append(std::span<const std::uint8_t> piece);
  void append(std::string_view piece);
  /// Replaces bytes that were appended, from the byte `at` on.
  void replace(std::uint64_t at, std::span<const std::uint8_t> piece);
  /// Returns when everything written so far is on the disk; at once when nothing was written since the last
  /// call.
  void sync();
  /// Closes the file; only sync() guarantees that it is on the disk. Closing twice is allowed.
  void close();

  std::uint64_t size() const { return size_; }                 ///< bytes
  const std::filesystem::path& path() const { return path_; }  ///< as given

 private:
  [[noreturn]] void fail(const char* what_failed, int error_number) const;

  std::filesystem::path path_, shown_;
  int descriptor_ = -1;
  std::uint64_t size_ = 0;
  std::uint64_t flushing_ = 0;  ///< bytes that the system was asked to write to the disk
  bool synced_ = false;         ///< nothing was written since the last sync()
};

/// Begins to write to the disk what was written to an open file, without waiting for it: flush_descriptor()
/// waits for less then. No effect on systems without such a call.
void start_flush(int descriptor);

/// Returns when everything written to an open file is on the disk. Throws Error(Errc::internal, shown).
void flush_descriptor(int descriptor, const std::filesystem::path& shown);

/// Returns when everything that any process has written to `file` is on the disk. Throws
/// Error(Errc::internal, file), also if the file does not exist.
void sync_file(const std::filesystem::path& file);

/// Renames the complete file `from` to its final name in the same file system, replacing an existing file.
/// Syncs content and name, so that both survive a power failure. Throws Error(Errc::internal, to).
void rename_complete(const std::filesystem::path& from, const std::filesystem::path& to);

/// Name of a file until it is complete and renamed: `path` + ".tmp".
std::filesystem::path temporary_name(const std::filesystem::path& path);

}  // namespace faba
