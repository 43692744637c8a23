#include "server/experiments/imports.h"

#include <fcntl.h>
#include <fmt/format.h>
#include <sys/stat.h>
#include <unistd.h>

#include <chrono>
#include <cstring>

#include "core/error.h"
#include "core/file.h"
#include "study/data/run_video.h"

namespace faba {
namespace {

namespace fs = std::filesystem;
constexpr const char* kVideoFolder = "videos";
constexpr std::string_view kPart = ".part";
constexpr std::uint64_t kSpare = 256u << 20;  // bytes that remain free for results

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
  if (free < needed + kSpare)
    throw Error(
        Errc::usage, "disk",
        fmt::format(
            "the file needs {:.1f} MB and {} MB are kept free for results, but only {:.1f} MB are free; "
            "delete runs or imported videos, or use faba lab --allow FOLDER to read it where it is",
            double(needed) / 1e6, kSpare / 1000000, double(free) / 1e6));
}

// Links are not followed: a part is a file of its folder.
void append(const fs::path& file, const std::string& bytes, std::uint64_t offset) {
  const int fd = ::open(file.c_str(), O_WRONLY | O_CREAT | O_NOFOLLOW | O_CLOEXEC, 0600);
  if (fd < 0) throw Error(Errc::internal, file.filename().string(), std::strerror(errno));
  std::size_t done = 0;
  while (done < bytes.size()) {
    const ssize_t n = ::pwrite(fd, bytes.data() + done, bytes.size() - done, off_t(offset + done));
    if (n < 0 && errno == EINTR) continue;
    if (n <= 0) break;
    done += std::size_t(n);
  }
  const int wrong = errno;
  if (done < bytes.size()) (void)::ftruncate(fd, off_t(offset));
  ::close(fd);
  if (done < bytes.size()) throw Error(Errc::internal, file.filename().string(), std::strerror(wrong));
}

fs::path unused(const fs::path& folder, const std::string& name) {
  const fs::path wanted(name);
  fs::path file = folder / wanted;
  for (int i = 2; fs::exists(fs::symlink_status(file)); ++i)
    file = folder / fmt::format("{}-{}{}", wanted.stem().string(), i, wanted.extension().string());
  return file;
}

// Throws Error(usage) for a file without frames.
void check_frames(const fs::path& file, const std::string& name) {
  try {
    check_has_frames(file);
  } catch (const Error& e) {
    throw Error(Errc::usage, name, e.reason());
  }
}

}  // namespace

Json Imports::incomplete(const std::string& experiment) const {
  const std::lock_guard lock(mutex_);
  Json all = Json::array();
  std::error_code ec;
  for (const auto& e : fs::directory_iterator(experiments_.folder(experiment) / kVideoFolder, ec)) {
    const std::string name = e.path().filename();
    const auto dash = name.find('-');
    if (!name.starts_with('.') || !name.ends_with(kPart) || dash == name.npos) continue;
    all.push_back({{"name", name.substr(dash + 1, name.size() - kPart.size() - dash - 1)},
                   {"size", std::strtoull(name.c_str() + 1, nullptr, 10)},
                   {"received", size_of(e.path())}});
  }
  return all;
}

std::uint64_t Imports::received(const std::string& experiment, const std::string& name,
                                std::uint64_t size) const {
  const std::lock_guard lock(mutex_);
  return size_of(experiments_.folder(experiment) / kVideoFolder / part_name(safe_name(name), size));
}

Json Imports::take(const std::string& experiment, const ImportPart& part, const std::string& bytes) {
  const std::string name = safe_name(fs::path(part.name).filename().string());
  if (name.empty()) throw Error(Errc::usage, "name", "is missing; it must be the name of the file");
  if (part.size == 0) throw Error(Errc::usage, part.name, "is empty");
  const std::lock_guard lock(mutex_);
  const fs::path folder = experiments_.folder(experiment) / kVideoFolder;
  fs::create_directories(folder);
  const fs::path partial = folder / part_name(name, part.size);
  const std::uint64_t received = size_of(partial);
  if (part.offset != received || part.offset + bytes.size() > part.size)
    throw Error(Errc::usage, "offset",
                fmt::format("{} is not the number of bytes received, {}", part.offset, received));
  check_space(folder, part.size - received);
  append(partial, bytes, received);
  const std::uint64_t now = received + bytes.size();
  if (now < part.size) return {{"received", now}};
  const fs::path file = unused(folder, name);
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
  const std::string relative = fmt::format("{}/{}", kVideoFolder, file.filename().string());
  experiments_.add_video(experiment, relative, part.drop);
  return {{"received", now}, {"file", relative}};
}

void Imports::cancel(const std::string& experiment, const std::string& name, std::uint64_t size) {
  const std::lock_guard lock(mutex_);
  fs::remove(experiments_.folder(experiment) / kVideoFolder / part_name(safe_name(name), size));
}

}  // namespace faba
