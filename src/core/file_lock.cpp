#include "core/file_lock.h"

#include <fcntl.h>
#include <fmt/format.h>
#include <sys/file.h>
#include <sys/stat.h>
#include <unistd.h>

#include <cerrno>
#include <fstream>
#include <system_error>
#include <utility>

#include "core/error.h"

namespace faba {
namespace {

constexpr const char* kFirst = "faba process ";

[[noreturn]] void fail(const std::filesystem::path& file, const char* what) {
  throw Error(Errc::internal, file.string(),
              fmt::format("{}: {}", what, std::generic_category().message(errno)));
}

std::string host() {
  char name[256] = {};
  return ::gethostname(name, sizeof name - 1) == 0 ? name : "";
}

// "process 17 on pc2": the number is of use on that host only.
std::string holder(const std::filesystem::path& file) {
  std::ifstream in(file);
  std::string line;
  std::getline(in, line);
  return line.starts_with(kFirst) ? "process " + line.substr(std::string(kFirst).size()) : "another process";
}

bool same_file(int descriptor, const std::filesystem::path& file) {
  struct stat a {
  }, b{};
  return fstat(descriptor, &a) == 0 && stat(file.c_str(), &b) == 0 && a.st_ino == b.st_ino &&
         a.st_dev == b.st_dev;
}

}  // namespace

FileLock::FileLock(const std::filesystem::path& file, const std::filesystem::path& shown,
                   const std::string& text, Errc held)
    : file_(file) {
  for (int attempt = 0; attempt < 100; ++attempt) {
    descriptor_ = ::open(file_.c_str(), O_RDWR | O_CREAT | O_CLOEXEC, 0666);
    if (descriptor_ < 0) fail(file_, "cannot be written");
    if (::flock(descriptor_, LOCK_EX | LOCK_NB) != 0 && errno == EWOULDBLOCK) {
      ::close(std::exchange(descriptor_, -1));
      throw Error(
          held, shown.string(),
          fmt::format("{} is writing to it; wait until it exits or choose another --out", holder(file_)));
    }
    if (same_file(descriptor_, file_)) break;  // otherwise the holder removed the file in the meantime
    ::close(std::exchange(descriptor_, -1));
  }
  if (descriptor_ < 0) fail(file_, "cannot be written");
  struct stat before {};
  const bool had_text = fstat(descriptor_, &before) != 0 || before.st_size > 0;
  // Overwrite, then truncate: on a full disk the text of an earlier process is kept.
  const std::string content = fmt::format("{}{} on {}\n{}", kFirst, getpid(), host(), text);
  errno = ENOSPC;  // reported after a partial write, which sets no errno
  if (::pwrite(descriptor_, content.data(), content.size(), 0) != ssize_t(content.size()) ||
      ::ftruncate(descriptor_, off_t(content.size())) != 0 || ::fsync(descriptor_) != 0) {
    const int reason = errno;
    if (!had_text) ::unlink(file_.c_str());
    ::close(std::exchange(descriptor_, -1));
    errno = reason;
    fail(file_, "cannot be written");
  }
}

FileLock::FileLock(FileLock&& other) noexcept
    : file_(std::move(other.file_)), descriptor_(std::exchange(other.descriptor_, -1)) {}

FileLock& FileLock::operator=(FileLock&& other) noexcept {
  std::swap(file_, other.file_);
  std::swap(descriptor_, other.descriptor_);
  return *this;
}

FileLock::~FileLock() {
  if (descriptor_ >= 0) ::close(descriptor_);
}

bool FileLock::held(const std::filesystem::path& file) {
  const int descriptor = ::open(file.c_str(), O_RDONLY | O_CLOEXEC | O_NOFOLLOW);
  if (descriptor < 0) return false;
  const bool other = ::flock(descriptor, LOCK_EX | LOCK_NB) != 0 && errno == EWOULDBLOCK;
  ::close(descriptor);
  return other;
}

void FileLock::complete() {
  if (::unlink(file_.c_str()) != 0) fail(file_, "cannot be removed");
  ::close(std::exchange(descriptor_, -1));
}

}  // namespace faba
