#pragma once
#include <filesystem>
#include <string>

#include "core/error.h"
#include "server/files/opened_path.h"

namespace faba {

/// The same error with `name` in place of every `path`.
Error renamed(const Error& e, const std::string& path, const std::string& name);

/// Calls `use` with a path of the file or folder `path`, a result of Workspace, which remains this file even
/// if another process replaces a folder on the way by a link. Errors have `name` in place of this path.
/// Throws Error(input) if `path` has a link now.
template <class F>
auto with_opened(const std::filesystem::path& path, const std::string& name, const F& use) {
  const OpenedPath opened = [&] {
    try {
      return OpenedPath(path);
    } catch (const Error& e) {
      throw renamed(e, path.string(), name);
    }
  }();
  try {
    return use(opened.path());
  } catch (const Error& e) {
    throw renamed(e, opened.path().string(), name);
  }
}

}  // namespace faba
