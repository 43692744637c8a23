#include "core/file.h"

#include <fcntl.h>
#include <fmt/format.h>
#include <unistd.h>

#include <cerrno>
#include <cstring>
#include <fstream>
#include <sstream>

#include "core/error.h"

namespace faba {
namespace {

[[noreturn]] void fail(const std::filesystem::path& file, const char* doing) {
  throw Error(Errc::internal, file.string(), fmt::format("cannot {}: {}", doing, std::strerror(errno)));
}

void write_all(int fd, std::string_view bytes, const std::filesystem::path& file) {
  while (!bytes.empty()) {
    const ssize_t n = ::write(fd, bytes.data(), bytes.size());
    if (n < 0 && errno == EINTR) continue;
    if (n < 0) fail(file, "write");
    bytes.remove_prefix(std::size_t(n));
  }
}

void sync_directory(const std::filesystem::path& dir) {
  const int fd = ::open(dir.empty() ? "." : dir.c_str(), O_RDONLY | O_DIRECTORY | O_CLOEXEC);
  if (fd < 0) return;  // some file systems do not allow it; the rename itself has been done
  ::fsync(fd);
  ::close(fd);
}

}  // namespace

void write_file(const std::filesystem::path& file, std::string_view content) {
  const std::filesystem::path temporary = file.string() + ".tmp";
  const int fd = ::open(temporary.c_str(), O_WRONLY | O_CREAT | O_TRUNC | O_CLOEXEC, 0644);
  if (fd < 0) fail(file, "create");
  try {
    write_all(fd, content, file);
    if (::fsync(fd) != 0) fail(file, "write");
  } catch (...) {
    ::close(fd);
    ::unlink(temporary.c_str());
    throw;
  }
  ::close(fd);
  if (::rename(temporary.c_str(), file.c_str()) != 0) {
    const int reason = errno;
    ::unlink(temporary.c_str());
    errno = reason;
    fail(file, "create");
  }
  sync_directory(file.parent_path());
}

std::string read_file(const std::filesystem::path& file) {
  std::error_code ec;
  if (!std::filesystem::exists(file, ec)) throw Error(Errc::input, file.string(), "no such file");
  if (std::filesystem::is_directory(file, ec))
    throw Error(Errc::input, file.string(), "is a directory, not a file");
  std::ifstream in(file, std::ios::binary);
  std::ostringstream out;
  out << in.rdbuf();
  if (!in) throw Error(Errc::input, file.string(), "cannot be read");
  return std::move(out).str();
}

AppendFile::AppendFile(std::filesystem::path file, std::uint64_t keep_bytes) : path_(std::move(file)) {
  fd_ = ::open(path_.c_str(), O_WRONLY | O_CREAT | O_CLOEXEC, 0644);
  if (fd_ < 0) fail(path_, "create");
  const off_t end = ::lseek(fd_, 0, SEEK_END);
  if (end < 0 || std::uint64_t(end) < keep_bytes) {
    ::close(fd_);
    throw Error(Errc::input, path_.string(),
                fmt::format("is shorter than the {} bytes its checkpoint names", keep_bytes));
  }
  // A device cannot be cut, nor need it be.
  if ((std::uint64_t(end) != keep_bytes && ::ftruncate(fd_, off_t(keep_bytes)) != 0) ||
      ::lseek(fd_, off_t(keep_bytes), SEEK_SET) < 0) {
    ::close(fd_);
    fail(path_, "cut back");
  }
  length_ = keep_bytes;
}

AppendFile::~AppendFile() {
  if (fd_ < 0) return;
  try {
    flush();
  } catch (const Error&) {  // the error was, or will be, reported by sync() or close(); a destructor cannot
  }
  ::close(fd_);
}

void AppendFile::flush() {
  write_all(fd_, buffer_, path_);
  buffer_.clear();
}

void AppendFile::write(std::string_view bytes) {
  buffer_ += bytes;
  length_ += bytes.size();
  if (buffer_.size() > 1u << 16) flush();
}

std::uint64_t AppendFile::sync() {
  flush();
  if (::fsync(fd_) != 0 && errno != EINVAL) fail(path_, "write");  // EINVAL: a device such as /dev/full
  return length_;
}

void AppendFile::close() {
  sync();
  const int fd = fd_;
  fd_ = -1;
  if (::close(fd) != 0) fail(path_, "close");
}

}  // namespace faba
