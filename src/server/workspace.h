#pragma once
#include <filesystem>
#include <string>
#include <string_view>
#include <vector>

#include "core/toml.h"

namespace faba {

/// The working folder of the lab. Pages use paths relative to it and cannot access files outside, except in
/// the folders that the user allows them to read.
class Workspace {
 public:
  /// `scenes`: the gallery if the workspace has no folder scenes/; need not exist. `allowed`: folders outside
  /// that pages may read. Throws Error(usage) if one is not a folder.
  Workspace(const std::filesystem::path& root, const std::filesystem::path& scenes,
            const std::vector<std::filesystem::path>& allowed = {});
  const std::filesystem::path& root() const { return root_; }
  /// Absolute, without links.
  const std::vector<std::filesystem::path>& allowed() const { return allowed_; }

  /// Absolute path of a relative name; the file need not exist. Throws Error(usage) for names outside the
  /// workspace, also through links, and for hidden files.
  std::filesystem::path inside(std::string_view name) const;
  /// The same for an existing file or folder; otherwise throws Error(input). The name may be an absolute path
  /// in an allowed folder. Runs and experiments are checked by check_links().
  std::filesystem::path existing(std::string_view name) const;
  /// Throws Error(usage) if a file in a folder is a link to a place that pages may not read: what the program
  /// reads of a run or an experiment has a fixed name, so a link is followed.
  void check_links(const std::filesystem::path& folder) const;
  /// Whether pages may read a file: it is in the workspace or in an allowed folder, also after its links are
  /// followed. It need not exist.
  bool may_read(const std::filesystem::path& file) const;
  /// The name by which pages know a file that they may read.
  std::string name_of(const std::filesystem::path& file) const;

  /// A scenario sent by a page; its file names are relative to the gallery.
  Document page_document(Json scenario) const;
  /// The location of an error without the name of the page document.
  std::string in_page(const std::string& where) const;
  /// Throws Error(usage) if a scenario sent by a page refers to a file that is neither in the workspace nor
  /// in the folder of the gallery's project, or to a path that is not a file.
  void check_files(const Json& scenario) const;

  /// The file that a scenario sent by a page refers to: relative to the gallery if it exists there, otherwise
  /// to the workspace. Throws Error(usage) as check_files(); the file need not exist.
  std::filesystem::path scenario_file(const std::string& name) const;
  /// Pictures and videos that may show a drop: the pictures in the workspace and its folders pictures/,
  /// videos/ and data/, and the videos of files().
  std::vector<std::string> pictures() const;
  /// Copies a file to pictures/, under a name that is not used yet; the result is relative to the workspace.
  /// `name`: the wanted name, with its extension; its folder is ignored. Throws Error(usage) as inside().
  std::string keep_picture(const std::filesystem::path& file, const std::string& name) const;

  const std::filesystem::path& gallery() const { return gallery_; }  ///< folder of the scenes
  /// Scenario files of the gallery, sorted.
  std::vector<std::filesystem::path> scenes() const;
  /// Scenario file with this stem. Throws Error(input) if not found.
  std::filesystem::path scene(std::string_view name) const;
  /// Names of the directories below runs/ with a recorded run, newest first.
  std::vector<std::string> runs() const;

 private:
  /// The same for a path without links.
  bool is_readable(const std::filesystem::path& real) const;

  std::filesystem::path root_, gallery_;
  std::vector<std::filesystem::path> allowed_;
};

}  // namespace faba
