#pragma once
#include <filesystem>
#include <string>
#include <string_view>
#include <vector>

#include "core/toml.h"

namespace faba {

/// The folder that the lab works in: where it was called. Pages name files by their way from there, and
/// nothing else can be reached, whatever a page asks for.
class Workspace {
 public:
  /// `scenes`: the gallery where the workspace has no folder scenes/ of its own; may be absent, too.
  Workspace(const std::filesystem::path& root, const std::filesystem::path& scenes);
  const std::filesystem::path& root() const { return root_; }

  /// The file that a relative name stands for, which need not exist. Throws Error(usage) for names that lead
  /// out of the workspace, also by links, and for hidden files.
  std::filesystem::path inside(std::string_view name) const;
  /// The same, and it must be a file or a folder that is there; else Error(input).
  std::filesystem::path existing(std::string_view name) const;

  /// A scenario that a page sent; files that it names are looked for beside the gallery's.
  Document page_document(Json scenario) const;
  /// Where something is wrong in it, without the name that it has here only.
  std::string in_page(const std::string& where) const;
  /// Throws Error(usage) when a scenario that a page sent names a file that is neither in the workspace nor
  /// beside the gallery, or something else than a file.
  void check_files(const Json& scenario) const;

  const std::filesystem::path& gallery() const { return gallery_; }  ///< folder of its scenes
  /// Its scenario files, sorted.
  std::vector<std::filesystem::path> scenes() const;
  /// The file of one of them. Throws Error(input) when there is none of that name.
  std::filesystem::path scene(std::string_view name) const;
  /// Names of the directories below runs/ that hold a recorded run, newest first.
  std::vector<std::string> runs() const;
  /// What the analyses take: videos and runs recorded as a camera sees them, studies with the verb that takes
  /// them, rigs.
  Json files() const;

 private:
  std::filesystem::path root_, gallery_;
};

}  // namespace faba
