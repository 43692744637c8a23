#include "server/files/opened_path.h"

#include <fcntl.h>
#include <fmt/format.h>
#include <sys/stat.h>
#include <unistd.h>

#include <cerrno>
#include <string>
#include <system_error>
#include <utility>

#include "core/error.h"

namespace faba {
namespace {

// O_PATH opens neither devices nor the content of files, and does not wait for the writer of a FIFO.
constexpr int kFlags = O_PATH | O_NOFOLLOW | O_CLOEXEC;

Error not_opened(const std::filesystem::path& path, int failure) {
  const bool moved = failure == ELOOP || failure == ENOTDIR;
  return {Errc::input, path.string(),
          moved ? "a folder of this path was replaced by a link; try again"
                : "file not found: " + std::generic_category().message(failure)};
}

mode_t type_of(int descriptor) {
  struct stat s {};
  return ::fstat(descriptor, &s) == 0 ? s.st_mode & S_IFMT : 0;
}

}  // namespace

OpenedPath::OpenedPath(const std::filesystem::path& path) {
  int folder = ::open("/", kFlags | O_DIRECTORY);
  for (const std::filesystem::path& part : path.relative_path()) {
    if (part.empty()) continue;  // of a trailing slash
    const int next = folder < 0 ? -1 : ::openat(folder, part.c_str(), kFlags);
    const int failure = errno;
    if (folder >= 0) ::close(folder);
    folder = next;
    // The last part is checked here too: with O_PATH a link itself would be opened.
    if (next >= 0 && type_of(next) != S_IFLNK) continue;
    if (next >= 0) ::close(next);
    throw not_opened(path, next >= 0 ? ELOOP : failure);
  }
  descriptor_ = folder;
}

OpenedPath::~OpenedPath() {
  if (descriptor_ >= 0) ::close(descriptor_);
}

OpenedPath::OpenedPath(OpenedPath&& other) noexcept : descriptor_(std::exchange(other.descriptor_, -1)) {}

std::filesystem::path OpenedPath::path() const { return fmt::format("/proc/self/fd/{}", descriptor_); }

bool OpenedPath::is_regular_file() const { return type_of(descriptor_) == S_IFREG; }

bool OpenedPath::is_directory() const { return type_of(descriptor_) == S_IFDIR; }

}  // namespace faba
