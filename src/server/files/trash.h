#pragma once
#include <cstdint>
#include <filesystem>
#include <functional>
#include <mutex>
#include <optional>
#include <string>
#include <vector>

#include "core/file_lock.h"
#include "server/workspace.h"

namespace faba {

/// Runs and imports that a page has deleted. They are in a hidden folder of the workspace, which pages cannot
/// access, until the lab ends; until then each deletion can be undone. Thread-safe.
class Trash {
 public:
  struct Item {
    int id = 0;
    std::string name;         ///< relative to the workspace, such as "runs/steer"
    std::uint64_t bytes = 0;  ///< size of its files
  };

  /// Removes what labs left behind that were killed. Throws Error(usage) if the folder of the trash is a link
  /// or a file.
  explicit Trash(const Workspace& workspace);
  /// Removes all deleted files.
  ~Trash();
  Trash(const Trash&) = delete;
  Trash& operator=(const Trash&) = delete;

  /// Moves a file or folder of the workspace, and the files `beside` that belong to it and need not exist.
  /// `restored`, if given, is called when undo() has moved the files back, and must not use the trash. Throws
  /// Error(input) if there is no such file, Error(usage) for a link and for a file on another file system.
  Item take(const std::string& name, const std::vector<std::string>& beside = {},
            std::function<void()> restored = {});
  /// Moves it back. Throws Error(input) if there is no such item, Error(usage) if its name is used again, and
  /// the errors of `restored`; then nothing is moved.
  Item undo(int id);
  /// The newest last.
  std::vector<Item> items() const;

 private:
  struct Moved {
    std::string name;            ///< relative to the workspace
    std::filesystem::path kept;  ///< in the folder of the trash
  };
  struct Kept {
    Item item;
    std::vector<Moved> moved;
    std::function<void()> restored;
  };
  std::filesystem::path place_of(const std::string& name) const;
  const std::filesystem::path& folder();

  const Workspace& workspace_;
  mutable std::mutex mutex_;
  std::filesystem::path folder_;  ///< of this lab; empty until something is deleted
  FileLock lock_;                 ///< of folder_
  std::vector<Kept> kept_;
  int next_ = 1;
};

/// Size of the files of a file or folder, bytes. Links are not followed.
std::uint64_t bytes_of(const std::filesystem::path& path);

/// Renames `from` to `to` of the same file system, unless `to` exists: then returns false. `name`: for
/// messages.
bool rename_new(const std::filesystem::path& from, const std::filesystem::path& to, const std::string& name);

}  // namespace faba
