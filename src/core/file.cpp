#include "core/file.h"

#include <fcntl.h>
#include <unistd.h>

#include <cerrno>
#include <fstream>
#include <sstream>
#include <system_error>

#include "core/error.h"

namespace faba {
namespace {

constexpr std::uint64_t kFlushedBytes = 4u << 20;  // sync() waits for fewer only for some milliseconds

std::string advice(int error_number) {
  std::string reason = std::generic_category().message(error_number);
  if (error_number == ENOSPC || error_number == EDQUOT)
    return reason + "; free some space or choose another disk";
  if (error_number == EACCES || error_number == EROFS || error_number == EPERM) {
    return reason + "; choose a writable location";
  }
  if (error_number == EFBIG)
    return reason + "; the file size limit (ulimit -f) or the limit of the file system is reached";
  if (error_number == ENOENT) return reason + "; does the folder exist?";
  return reason;
}

void flush_path(const std::filesystem::path& path, int flags, const std::filesystem::path& shown) {
  const int descriptor = ::open(path.c_str(), flags | O_RDONLY | O_CLOEXEC);
  if (descriptor < 0) throw Error(Errc::internal, shown.string(), "cannot be flushed: " + advice(errno));
  try {
    flush_descriptor(descriptor, shown);
  } catch (...) {
    ::close(descriptor);
    throw;
  }
  ::close(descriptor);  // opened for reading only: an error of close() does not concern the content
}

// Creates a file; follows no link.
void write_new(const std::filesystem::path& path, std::initializer_list<std::string_view> pieces,
               const std::filesystem::path& shown) {
  const int descriptor = ::open(path.c_str(), O_WRONLY | O_CREAT | O_EXCL | O_NOFOLLOW | O_CLOEXEC, 0666);
  int failure = descriptor < 0 ? errno : 0;
  for (std::string_view rest : pieces)
    while (failure == 0 && !rest.empty()) {
      const ssize_t written = ::write(descriptor, rest.data(), rest.size());
      if (written >= 0)
        rest.remove_prefix(std::size_t(written));
      else if (errno != EINTR)
        failure = errno;
    }
  if (descriptor >= 0 && ::close(descriptor) != 0 && failure == 0 && errno != EINTR) failure = errno;
  if (failure != 0) throw Error(Errc::internal, shown.string(), "cannot be written: " + advice(failure));
}

}  // namespace

void write_file(const std::filesystem::path& file, std::string_view content) { write_file(file, {content}); }

void write_file(const std::filesystem::path& file, std::initializer_list<std::string_view> pieces) {
  const std::filesystem::path temporary = temporary_name(file);
  // What is there is of a process that was killed, or a link or another name of a file that must not change.
  ::unlink(temporary.c_str());
  try {
    write_new(temporary, pieces, file);
    rename_complete(temporary, file);
  } catch (...) {
    std::error_code ignored;
    std::filesystem::remove(temporary, ignored);
    throw;
  }
}

std::string read_file(const std::filesystem::path& file) {
  std::error_code ec;
  if (!std::filesystem::exists(file, ec))
    throw Error(Errc::input, file.string(), "file not found; check the name");
  if (std::filesystem::is_directory(file, ec))
    throw Error(Errc::input, file.string(), "is a directory, not a file");
  std::ifstream in(file, std::ios::binary);
  std::ostringstream out;
  out << in.rdbuf();
  if (!in) throw Error(Errc::input, file.string(), "cannot be read");
  return std::move(out).str();
}

OutputFile::OutputFile(const std::filesystem::path& path, std::uint64_t keep_bytes,
                       const std::filesystem::path& shown)
    : path_(path), shown_(shown.empty() ? path : shown), size_(keep_bytes), flushing_(keep_bytes) {
  const int flags = keep_bytes == 0 ? O_WRONLY | O_CREAT | O_TRUNC : O_WRONLY;
  descriptor_ = ::open(path.c_str(), flags | O_CLOEXEC, 0666);
  if (descriptor_ < 0 && keep_bytes > 0 && errno == ENOENT)
    throw Error(Errc::input, shown_.string(),
                "file not found, so it cannot be continued; start again from scratch");
  if (descriptor_ < 0) fail("cannot be written", errno);
  if (keep_bytes == 0) return;
  try {
    const off_t end = ::lseek(descriptor_, 0, SEEK_END);
    if (end < 0) fail("cannot be continued", errno);
    if (static_cast<std::uint64_t>(end) < keep_bytes) {
      throw Error(Errc::input, shown_.string(),
                  "has " + std::to_string(end) + " bytes, fewer than the " + std::to_string(keep_bytes) +
                      " bytes that were written before, so it cannot be continued; start again from scratch");
    }
    if (::ftruncate(descriptor_, static_cast<off_t>(keep_bytes)) != 0) fail("cannot be truncated", errno);
    if (::lseek(descriptor_, 0, SEEK_END) < 0) fail("cannot be continued", errno);
  } catch (...) {
    ::close(descriptor_);
    throw;
  }
}

OutputFile::~OutputFile() {
  if (descriptor_ >= 0) ::close(descriptor_);
}

void OutputFile::fail(const char* what_failed, int error_number) const {
  throw Error(Errc::internal, shown_.string(), std::string(what_failed) + ": " + advice(error_number));
}

void OutputFile::append(std::span<const std::uint8_t> piece) {
  synced_ = false;
  for (auto rest = piece; !rest.empty();) {
    const ssize_t written = ::write(descriptor_, rest.data(), rest.size());
    if (written >= 0) {
      rest = rest.subspan(static_cast<std::size_t>(written));
    } else if (errno != EINTR) {
      const int failure = errno;
      const auto complete = static_cast<off_t>(size_);
      // A device such as /dev/full cannot be truncated and stores nothing.
      if (::ftruncate(descriptor_, complete) == 0) ::lseek(descriptor_, complete, SEEK_SET);
      fail("cannot be written", failure);
    }
  }
  size_ += piece.size();
  if (size_ < flushing_ + kFlushedBytes) return;
  start_flush(descriptor_);
  flushing_ = size_;
}

void OutputFile::replace(std::uint64_t at, std::span<const std::uint8_t> piece) {
  synced_ = false;
  while (!piece.empty()) {
    const ssize_t written = ::pwrite(descriptor_, piece.data(), piece.size(), static_cast<off_t>(at));
    if (written < 0 && errno != EINTR) fail("cannot be written", errno);
    if (written < 0) continue;
    at += static_cast<std::uint64_t>(written);
    piece = piece.subspan(static_cast<std::size_t>(written));
  }
}
void OutputFile::append(std::string_view piece) {
  append(std::span(reinterpret_cast<const std::uint8_t*>(piece.data()), piece.size()));
}

void OutputFile::sync() {
  if (synced_) return;
  flush_descriptor(descriptor_, shown_);
  synced_ = true;
}

void OutputFile::close() {
  if (descriptor_ < 0) return;
  const int descriptor = descriptor_;
  descriptor_ = -1;
  if (::close(descriptor) != 0 && errno != EINTR) fail("cannot be closed", errno);
}

void start_flush([[maybe_unused]] int descriptor) {
#ifdef __linux__
  // What cannot be written is reported by fsync().
  ::sync_file_range(descriptor, 0, 0, SYNC_FILE_RANGE_WRITE);
#endif
}

void flush_descriptor(int descriptor, const std::filesystem::path& shown) {
  if (::fsync(descriptor) == 0) return;
  // Devices and some network file systems do not support fsync.
  if (errno != EINVAL && errno != ENOTSUP)
    throw Error(Errc::internal, shown.string(), "cannot be flushed to the disk: " + advice(errno));
}

void sync_file(const std::filesystem::path& file) { flush_path(file, 0, file); }

void rename_complete(const std::filesystem::path& from, const std::filesystem::path& to) {
  flush_path(from, 0, to);
  std::error_code failure;
  std::filesystem::rename(from, to, failure);
  if (failure)
    throw Error(Errc::internal, to.string(),
                "cannot be renamed to its final name: " + advice(failure.value()));
  const auto folder = to.has_parent_path() ? to.parent_path() : std::filesystem::path(".");
  flush_path(folder, O_DIRECTORY, to);
}

std::filesystem::path temporary_name(const std::filesystem::path& path) { return path.string() + ".tmp"; }

}  // namespace faba
