#include "server/experiments/imports.h"

#include <fcntl.h>
#include <fmt/format.h>
#include <sys/stat.h>
#include <unistd.h>

#include <chrono>
#include <cstring>

#include "core/error.h"
#include "core/file.h"
#include "server/files/disk_space.h"
#include "server/files/opened_input.h"
#include "study/data/run_video.h"

namespace faba {
namespace {

namespace fs = std::filesystem;
constexpr std::string_view kPart = ".part";
constexpr std::size_t kMostParts = 200;          // incomplete uploads of an experiment
constexpr std::int64_t kLatest = 7'258'118'400;  // s, the year 2200

// Hidden, so that pages cannot read it; size and name identify the file of the user.
std::string part_name(const std::string& name, std::uint64_t size) {
  return fmt::format(".{}-{}{}", size, name, kPart);
}

std::uint64_t size_of(const fs::path& file) {
  std::error_code ec;
  const std::uintmax_t size = fs::file_size(file, ec);
  return ec ? 0 : size;
}

void check_space(const fs::path& folder, std::uint64_t needed) {
  const std::uint64_t free = fs::space(folder).available;
  if (free < kSpareDisk || free - kSpareDisk < needed)
    throw Error(
        Errc::usage, "disk",
        fmt::format(
            "the file needs {:.1f} MB and {} MB are kept free for results, but only {:.1f} MB are free; "
            "delete runs or imported videos, or use faba lab --allow FOLDER to read it where it is",
            double(needed) / 1e6, kSpareDisk / 1000000, double(free) / 1e6));
}

// Links are not followed, and no file with a second name is changed: a part is a file of its folder.
void append(const fs::path& file, const std::string& bytes, std::uint64_t offset) {
  const int fd = ::open(file.c_str(), O_WRONLY | O_CREAT | O_NOFOLLOW | O_NONBLOCK | O_CLOEXEC, 0600);
  if (fd < 0) throw Error(Errc::internal, file.filename().string(), std::strerror(errno));
  struct stat s {};
  if (::fstat(fd, &s) != 0 || !S_ISREG(s.st_mode) || s.st_nlink != 1) {
    ::close(fd);
    throw Error(Errc::usage, file.filename().string(),
                "is not a file of its own: it is a device or has a second name (hard link); delete it");
  }
  std::size_t done = 0;
  while (done < bytes.size()) {
    const ssize_t n = ::pwrite(fd, bytes.data() + done, bytes.size() - done, off_t(offset + done));
    if (n < 0 && errno == EINTR) continue;
    if (n <= 0) break;
    done += std::size_t(n);
  }
  std::string wrong;
  if (done < bytes.size()) {
    wrong = std::strerror(errno);
    // The page sends this piece again.
    if (::ftruncate(fd, off_t(offset)) != 0) wrong += "; the file is incomplete, delete it";
  }
  ::close(fd);
  if (!wrong.empty()) throw Error(Errc::internal, file.filename().string(), wrong);
}

fs::path unused(const fs::path& folder, const std::string& name) {
  const fs::path wanted(name);
  fs::path file = folder / wanted;
  for (int i = 2; fs::exists(fs::symlink_status(file)); ++i)
    file = folder / fmt::format("{}-{}{}", wanted.stem().string(), i, wanted.extension().string());
  return file;
}

Json parts_in(const fs::path& folder) {
  Json all = Json::array();
  std::error_code ec;
  for (const auto& e : fs::directory_iterator(folder, ec)) {
    const std::string name = e.path().filename();
    const auto dash = name.find('-');
    if (!name.starts_with('.') || !name.ends_with(kPart) || dash == name.npos) continue;
    all.push_back({{"name", name.substr(dash + 1, name.size() - kPart.size() - dash - 1)},
                   {"size", std::strtoull(name.c_str() + 1, nullptr, 10)},
                   {"received", size_of(e.path())}});
  }
  return all;
}

// Throws Error(usage) for a file without frames.
void check_frames(const fs::path& file, const std::string& name) {
  try {
    check_has_frames(file);
  } catch (const Error& e) {
    throw Error(Errc::usage, name, e.reason());
  }
}

// Bytes of the file after this part.
std::uint64_t append_part(const fs::path& partial, const ImportPart& part, const std::string& bytes) {
  const std::uint64_t received = size_of(partial);
  if (part.offset != received || bytes.size() > part.size - received)
    throw Error(Errc::usage, "offset",
                fmt::format("{} is not the number of bytes received, {}", part.offset, received));
  if (received == 0 && parts_in(partial.parent_path()).size() >= kMostParts)
    throw Error(Errc::usage, part.name,
                fmt::format("{} uploads of this experiment are incomplete, the maximum; cancel some of them",
                            kMostParts));
  check_space(partial.parent_path(), part.size - received);
  append(partial, bytes, received);
  return received + bytes.size();
}

// Gives a complete file its name; it is removed if it has no frames.
std::string finish(const fs::path& partial, const std::string& name, const ImportPart& part) {
  const fs::path file = unused(partial.parent_path(), name);
  fs::rename(partial, file);
  try {
    check_frames(file, part.name);
  } catch (const Error&) {
    fs::remove(file);
    throw;
  }
  if (part.modified_s > 0)
    fs::last_write_time(file, fs::file_time_type::clock::from_sys(
                                  std::chrono::sys_seconds(std::chrono::seconds(part.modified_s))));
  return file.filename();
}

}  // namespace

Json Imports::incomplete(const std::string& experiment) const {
  const std::lock_guard lock(mutex_);
  return parts_in(experiments_.video_folder(experiment));
}

std::uint64_t Imports::received(const std::string& experiment, const std::string& name,
                                std::uint64_t size) const {
  const std::lock_guard lock(mutex_);
  return size_of(experiments_.video_folder(experiment) / part_name(safe_name(name), size));
}

Json Imports::take(const std::string& experiment, const ImportPart& part, const std::string& bytes) {
  const std::string name = safe_name(fs::path(part.name).filename().string());
  if (name.empty()) throw Error(Errc::usage, "name", "is missing; it must be the name of the file");
  if (part.size == 0) throw Error(Errc::usage, part.name, "is empty");
  if (part.modified_s < 0 || part.modified_s > kLatest)
    throw Error(Errc::usage, "modified",
                fmt::format("{} s must be a time between 1970 and 2200", part.modified_s));
  const std::lock_guard lock(mutex_);
  std::string file;
  std::uint64_t received = 0;
  with_opened(experiments_.video_folder(experiment), part.name, [&](const fs::path& folder) {
    const fs::path partial = folder / part_name(name, part.size);
    received = append_part(partial, part, bytes);
    if (received == part.size) file = finish(partial, name, part);
  });
  if (file.empty()) return {{"received", received}};
  const std::string relative = fmt::format("videos/{}", file);
  experiments_.add_video(experiment, relative, part.drop);
  return {{"received", received}, {"file", relative}};
}

void Imports::cancel(const std::string& experiment, const std::string& name, std::uint64_t size) {
  const std::lock_guard lock(mutex_);
  with_opened(experiments_.video_folder(experiment), name,
              [&](const fs::path& folder) { fs::remove(folder / part_name(safe_name(name), size)); });
}

}  // namespace faba
