#include "server/files/trash.h"

#include <fcntl.h>
#include <fmt/format.h>
#include <signal.h>
#include <stdio.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <charconv>
#include <system_error>

#include "core/error.h"

namespace faba {
namespace {

namespace fs = std::filesystem;
constexpr const char* kTrashFolder = ".faba-trash";
constexpr const char* kLock = "lab";

bool is_there(const fs::path& path) {
  std::error_code ec;
  return fs::exists(fs::symlink_status(path, ec));
}

// The process of a folder "PID-N"; 0 for other names.
pid_t process_of(const fs::path& folder) {
  const std::string name = folder.filename();
  pid_t pid = 0;
  const auto [end, wrong] = std::from_chars(name.data(), name.data() + name.size(), pid);
  return wrong == std::errc() && end != name.data() + name.size() && *end == '-' ? pid : 0;
}

// Whether a folder of the trash belongs to a lab that has ended. The lock alone would do, but some network
// file systems have no locks.
bool is_abandoned(const fs::path& folder) {
  const pid_t pid = process_of(folder);
  if (pid <= 0 || FileLock::held(folder / kLock)) return false;
  const bool alive = ::kill(pid, 0) == 0 || errno == EPERM;
  return !alive || pid == ::getpid();
}

}  // namespace

std::uint64_t bytes_of(const fs::path& path) {
  std::error_code ec;
  const fs::file_status status = fs::symlink_status(path, ec);
  if (fs::is_regular_file(status)) {
    const std::uintmax_t size = fs::file_size(path, ec);
    return ec ? 0 : size;
  }
  std::uint64_t bytes = 0;
  if (!fs::is_directory(status)) return bytes;
  for (const auto& e : fs::directory_iterator(path, ec)) bytes += bytes_of(e.path());
  return bytes;
}

bool rename_new(const fs::path& from, const fs::path& to, const std::string& name) {
  int failed = ::renameat2(AT_FDCWD, from.c_str(), AT_FDCWD, to.c_str(), RENAME_NOREPLACE) == 0 ? 0 : errno;
  // Not every file system has this flag.
  if (failed == EINVAL) {
    if (is_there(to)) return false;
    failed = ::rename(from.c_str(), to.c_str()) == 0 ? 0 : errno;
  }
  if (failed == 0) return true;
  if (failed == EEXIST) return false;
  if (failed == EXDEV)
    throw Error(Errc::usage, name,
                "is on another file system than the folder in which the lab was started; move or delete it "
                "outside of the lab");
  throw Error(Errc::internal, name,
              fmt::format("cannot be moved: {}", std::generic_category().message(failed)));
}

Trash::Trash(const Workspace& workspace) : workspace_(workspace) {
  const fs::path all = workspace_.root() / kTrashFolder;
  if (!is_there(all)) return;
  if (!fs::is_directory(fs::symlink_status(all)))
    throw Error(Errc::usage, all.string(), "is not a folder; the lab keeps deleted runs there; remove it");
  std::error_code ec;
  std::vector<fs::path> abandoned;
  for (const auto& e : fs::directory_iterator(all, ec))
    if (is_abandoned(e.path())) abandoned.push_back(e.path());
  for (const fs::path& folder : abandoned) fs::remove_all(folder, ec);
  fs::remove(all, ec);  // if it is empty
}

Trash::~Trash() {
  if (folder_.empty()) return;
  std::error_code ec;
  fs::remove_all(folder_, ec);
  fs::remove(folder_.parent_path(), ec);  // if no other lab uses it
}

const fs::path& Trash::folder() {
  if (!folder_.empty()) return folder_;
  const fs::path all = workspace_.root() / kTrashFolder;
  std::error_code ec;
  for (int n = 1; n < 1000; ++n) {
    fs::create_directory(all, ec);
    const fs::path mine = all / fmt::format("{}-{}", ::getpid(), n);
    if (!fs::is_directory(fs::symlink_status(all, ec)) || !fs::create_directory(mine, ec)) continue;
    fs::permissions(mine, fs::perms::owner_all, ec);
    lock_ = FileLock(mine / kLock, mine, "");
    folder_ = mine;
    return folder_;
  }
  throw Error(Errc::internal, all.string(),
              fmt::format("no folder can be created here for deleted files: {}", ec.message()));
}

// The folder is resolved, the last name is not: a link would be moved, not its target.
fs::path Trash::place_of(const std::string& name) const {
  (void)workspace_.inside(name);
  const fs::path relative(name);
  const fs::path parent =
      relative.has_parent_path() ? workspace_.inside(relative.parent_path().string()) : workspace_.root();
  return parent / relative.filename();
}

Trash::Item Trash::take(const std::string& name, const std::vector<std::string>& beside,
                        std::function<void()> restored) {
  const std::lock_guard lock(mutex_);
  const fs::path place = place_of(name);
  std::error_code ec;
  if (!is_there(place)) throw Error(Errc::input, name, "not found in the folder of the lab");
  if (fs::is_symlink(place, ec))
    throw Error(Errc::usage, name, "is a link; delete the link or its target outside of the lab");
  const int id = next_++;
  const fs::path mine = folder() / std::to_string(id);
  fs::create_directory(mine);
  Kept kept{{id, name, bytes_of(place)}, {{name, mine / "0"}}, std::move(restored)};
  if (!rename_new(place, mine / "0", name)) throw Error(Errc::internal, name, "cannot be deleted; try again");
  for (const std::string& other : beside) {
    const fs::path from = place_of(other), to = mine / std::to_string(kept.moved.size());
    if (!is_there(from) || fs::is_symlink(from, ec)) continue;
    const std::uint64_t bytes = bytes_of(from);
    if (!rename_new(from, to, other)) continue;
    kept.item.bytes += bytes;
    kept.moved.push_back({other, to});
  }
  kept_.push_back(std::move(kept));
  return kept_.back().item;
}

Trash::Item Trash::undo(int id) {
  const std::lock_guard lock(mutex_);
  const auto it = std::find_if(kept_.begin(), kept_.end(), [&](const Kept& k) { return k.item.id == id; });
  if (it == kept_.end())
    throw Error(Errc::input, std::to_string(id),
                "is not a deletion that can be undone; it may be undone already");
  const auto used = [](const std::string& name) {
    return Error(Errc::usage, name, "the name is used again; rename or delete the new one, then undo");
  };
  for (const Moved& m : it->moved)
    if (is_there(place_of(m.name))) throw used(m.name);
  std::vector<const Moved*> done;
  const auto back_to_trash = [&] {
    for (; !done.empty(); done.pop_back())
      rename_new(place_of(done.back()->name), done.back()->kept, done.back()->name);
  };
  for (const Moved& m : it->moved) {
    const fs::path place = place_of(m.name);
    fs::create_directories(place.parent_path());
    if (!rename_new(m.kept, place, m.name)) {
      back_to_trash();
      throw used(m.name);
    }
    done.push_back(&m);
  }
  try {
    if (it->restored) it->restored();
  } catch (const Error&) {
    back_to_trash();
    throw;
  }
  Item item = it->item;
  std::error_code ec;
  fs::remove(it->moved.front().kept.parent_path(), ec);
  kept_.erase(it);
  return item;
}

std::vector<Trash::Item> Trash::items() const {
  const std::lock_guard lock(mutex_);
  std::vector<Item> all;
  for (const Kept& k : kept_) all.push_back(k.item);
  return all;
}

}  // namespace faba
