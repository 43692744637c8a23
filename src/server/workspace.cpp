#include "server/workspace.h"

#include <algorithm>
#include <array>

#include "app/recording/run_lock.h"
#include "app/recording/session.h"
#include "core/error.h"

namespace faba {
namespace {

namespace fs = std::filesystem;
constexpr std::size_t kLongest = 1000;
constexpr std::size_t kMostFiles = 500;

Error out_of_reach(std::string_view name) {
  return {Errc::usage, std::string(name.substr(0, 80)), "is outside the folder in which the lab was started"};
}

std::vector<fs::path> sorted_files(const fs::path& folder, std::string_view extension) {
  std::vector<fs::path> found;
  std::error_code ec;
  for (const auto& e : fs::directory_iterator(folder, ec))
    if (e.is_regular_file(ec) && e.path().extension() == extension && found.size() < kMostFiles)
      found.push_back(e.path());
  std::sort(found.begin(), found.end());
  return found;
}

bool holds_run(const fs::path& dir) {
  std::error_code ec;
  return fs::is_regular_file(dir / run_files::kManifest, ec) &&
         fs::is_regular_file(dir / run_files::kScenario, ec);
}

}  // namespace

Workspace::Workspace(const fs::path& root, const fs::path& scenes) : root_(fs::canonical(root)) {
  gallery_ = fs::is_directory(root_ / "scenes") ? root_ / "scenes" : scenes;
}

fs::path Workspace::inside(std::string_view name) const {
  const fs::path asked(name);
  if (name.empty() || name.size() > kLongest || name.find('\0') != std::string_view::npos ||
      asked.is_absolute())
    throw out_of_reach(name);
  for (const fs::path& part : asked)
    if (part == ".." || part.string().starts_with('.')) throw out_of_reach(name);
  // Links are resolved before the check.
  std::error_code ec;
  fs::path real = fs::weakly_canonical(root_ / asked, ec);
  const auto [at, _] = std::mismatch(root_.begin(), root_.end(), real.begin(), real.end());
  if (ec || at != root_.end()) throw out_of_reach(name);
  return real;
}

fs::path Workspace::existing(std::string_view name) const {
  fs::path path = inside(name);
  std::error_code ec;
  if (!fs::is_regular_file(path, ec) && !fs::is_directory(path, ec))
    throw Error(Errc::input, std::string(name), "file not found in the folder in which the lab was started");
  return path;
}

Document Workspace::page_document(Json scenario) const {
  Document d;
  d.name = (gallery_ / "page").string();
  d.root = std::move(scenario);
  return d;
}

std::string Workspace::in_page(const std::string& where) const {
  const std::string name = (gallery_ / "page").string() + ": ";
  return where.starts_with(name) ? where.substr(name.size()) : where;
}

void Workspace::check_files(const Json& scenario) const {
  constexpr std::array<std::string_view, 2> kNaming = {"file", "background"};  // keys with a file name
  const auto lies_below = [](const fs::path& folder, const fs::path& file) {
    return std::mismatch(folder.begin(), folder.end(), file.begin(), file.end()).first == folder.end();
  };
  const fs::path project = gallery_.parent_path();  // scenes refer to ../rigs
  for (const auto& [key, value] : scenario.items()) {
    if (value.is_structured()) check_files(value);
    if (!value.is_string() || std::find(kNaming.begin(), kNaming.end(), key) == kNaming.end()) continue;
    const std::string name = value.get<std::string>();
    if (name.empty()) continue;  // a resolved scenario has every key: "" means no file
    // Search order of a scenario: its folder, then the working directory.
    std::error_code ec;
    const bool beside = fs::exists(gallery_ / name, ec);
    const fs::path real = fs::weakly_canonical((beside ? gallery_ : root_) / name, ec);
    if (ec || (!lies_below(root_, real) && (project.empty() || !lies_below(project, real))))
      throw out_of_reach(name);
    if (fs::exists(real, ec) && !fs::is_regular_file(real, ec))
      throw Error(Errc::usage, name, "is not a file");
  }
}

std::vector<fs::path> Workspace::scenes() const { return sorted_files(gallery_, ".toml"); }

fs::path Workspace::scene(std::string_view name) const {
  for (const fs::path& file : scenes())
    if (file.stem() == fs::path(name)) return file;
  throw Error(Errc::input, std::string(name.substr(0, 80)), "scene not found");
}

std::vector<std::string> Workspace::runs() const {
  std::vector<std::pair<fs::file_time_type, std::string>> found;
  std::error_code ec;
  for (const auto& e : fs::directory_iterator(root_ / "runs", ec)) {
    if (!e.is_directory(ec) || e.path().filename().string().starts_with('.') || !holds_run(e.path()))
      continue;
    found.emplace_back(fs::last_write_time(e.path() / run_files::kManifest, ec),
                       e.path().filename().string());
  }
  std::sort(found.rbegin(), found.rend());
  std::vector<std::string> names;
  for (auto& [_, name] : found)
    if (names.size() < kMostFiles) names.push_back(std::move(name));
  return names;
}

}  // namespace faba
