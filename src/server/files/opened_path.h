#pragma once
#include <filesystem>

namespace faba {

/// A file or folder that was opened through a path without symbolic links. A folder on the way may be
/// replaced by a link between the check of a path and its use; path() remains the file or folder that was
/// opened.
class OpenedPath {
 public:
  /// `path`: absolute, without links, as fs::canonical() returns. Throws Error(input, path) if it is missing,
  /// or if a part of it is a link now.
  explicit OpenedPath(const std::filesystem::path& path);
  ~OpenedPath();
  OpenedPath(OpenedPath&& other) noexcept;
  OpenedPath& operator=(OpenedPath&&) = delete;
  OpenedPath(const OpenedPath&) = delete;
  OpenedPath& operator=(const OpenedPath&) = delete;

  /// Another name of it for this process, valid while this object exists.
  std::filesystem::path path() const;
  bool is_regular_file() const;
  bool is_directory() const;

 private:
  int descriptor_ = -1;
};

}  // namespace faba
