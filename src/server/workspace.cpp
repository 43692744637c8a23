#include "server/workspace.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>

#include "app/recording/run_lock.h"
#include "app/recording/session.h"
#include "core/error.h"
#include "server/files/file_kinds.h"
#include "server/scenarios/gallery_index.h"
#include "study/data/run_video.h"
#include "study/experiment/experiment.h"

namespace faba {
namespace {

namespace fs = std::filesystem;
constexpr std::size_t kLongest = 1000;
constexpr std::size_t kMostFiles = 500, kMostRuns = 5000;
constexpr const char* kPictureFolder = "pictures";

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

// Whether an absolute path without links is in a folder, and neither the file nor a folder on the way is
// hidden.
bool lies_below(const fs::path& folder, const fs::path& file) {
  if (std::mismatch(folder.begin(), folder.end(), file.begin(), file.end()).first != folder.end())
    return false;
  const fs::path below = file.lexically_relative(folder);
  return std::none_of(below.begin(), below.end(),
                      [](const fs::path& part) { return part != "." && part.string().starts_with('.'); });
}

bool holds_run(const fs::path& dir) {
  std::error_code ec;
  return fs::is_regular_file(dir / run_files::kManifest, ec) &&
         fs::is_regular_file(dir / run_files::kScenario, ec);
}

}  // namespace

Workspace::Workspace(const fs::path& root, const fs::path& scenes, const std::vector<fs::path>& allowed)
    : root_(fs::canonical(root)) {
  gallery_ = fs::is_directory(root_ / "scenes") ? root_ / "scenes" : scenes;
  for (const fs::path& folder : allowed) {
    std::error_code ec;
    if (!fs::is_directory(folder, ec)) throw Error(Errc::usage, folder.string(), "is not a folder");
    allowed_.push_back(fs::canonical(folder));
  }
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
  if (ec || !lies_below(root_, real)) throw out_of_reach(name);
  return real;
}

bool Workspace::may_read(const fs::path& file) const {
  std::error_code ec;
  const fs::path real = fs::weakly_canonical(file, ec);
  return !ec && is_readable(real);
}

bool Workspace::is_readable(const fs::path& real) const {
  return lies_below(root_, real) ||
         std::any_of(allowed_.begin(), allowed_.end(),
                     [&](const fs::path& folder) { return lies_below(folder, real); });
}

std::string Workspace::name_of(const fs::path& file) const {
  std::error_code ec;
  const fs::path real = fs::weakly_canonical(file, ec);
  return lies_below(root_, real) ? real.lexically_relative(root_).string() : real.string();
}

fs::path Workspace::existing(std::string_view name) const {
  std::error_code ec;
  const bool absolute = name.starts_with('/') && name.size() <= kLongest && name.find('\0') == name.npos;
  // The path is resolved once: the result is checked, because a folder may be replaced by a link meanwhile.
  fs::path path = absolute ? fs::weakly_canonical(name, ec) : inside(name);
  if (ec || !is_readable(path)) throw out_of_reach(name);
  if (!fs::is_regular_file(path, ec) && !fs::is_directory(path, ec))
    throw Error(Errc::input, std::string(name), "file not found in the folder in which the lab was started");
  if (fs::exists(path / run_files::kManifest, ec) || experiment_file(path)) check_links(path);
  return path;
}

void Workspace::check_links(const fs::path& folder) const {
  std::error_code ec;
  for (const auto& e : fs::directory_iterator(folder, ec))
    if (e.is_symlink(ec) && !may_read(e.path()))
      throw Error(
          Errc::usage, name_of(folder) + "/" + e.path().filename().string(),
          "is a link to a place outside of the folder in which the lab was started; remove the link, or "
          "use faba lab --allow FOLDER");
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
  for (const auto& [key, value] : scenario.items()) {
    if (value.is_structured()) check_files(value);
    if (!value.is_string() || std::find(kNaming.begin(), kNaming.end(), key) == kNaming.end()) continue;
    const std::string name = value.get<std::string>();
    if (name.empty()) continue;  // a resolved scenario has every key: "" means no file
    (void)scenario_file(name);
  }
}

fs::path Workspace::scenario_file(const std::string& name) const {
  const fs::path project = gallery_.parent_path();  // scenes refer to ../rigs
  // Search order of a scenario: its folder, then the working directory.
  std::error_code ec;
  const bool beside = fs::exists(gallery_ / name, ec);
  fs::path real = fs::weakly_canonical((beside ? gallery_ : root_) / name, ec);
  if (ec || (!lies_below(root_, real) && (project.empty() || !lies_below(project, real))))
    throw out_of_reach(name);
  if (fs::exists(real, ec) && !fs::is_regular_file(real, ec)) throw Error(Errc::usage, name, "is not a file");
  return real;
}

std::vector<std::string> Workspace::pictures() const {
  std::vector<std::string> found;
  std::error_code ec;
  for (const char* folder : {".", kPictureFolder, "videos", "data"})
    for (const fs::directory_entry& e : fs::directory_iterator(root_ / folder, ec))
      if ((has_video_extension(e.path()) || has_picture_extension(e.path())) && may_read(e.path()) &&
          found.size() < kMostFiles)
        found.push_back(name_of(e.path()));
  std::sort(found.begin(), found.end());
  for (const std::string& run : runs()) {
    try {
      if (has_camera_video(root_ / "runs" / run)) found.push_back("runs/" + run);
    } catch (const Error&) {
      continue;  // damaged or incomplete
    }
  }
  return found;
}

std::string Workspace::keep_picture(const fs::path& file, const std::string& name) const {
  const fs::path wanted = fs::path(name).filename();
  if (wanted.empty() || wanted.string().starts_with('.'))
    throw Error(Errc::usage, "name",
                fmt::format("\"{}\" is not the name of a visible file", name.substr(0, 80)));
  const fs::path folder = inside(fmt::format("{}/{}", kPictureFolder, wanted.string())).parent_path();
  fs::create_directories(folder);
  for (int i = 1;; ++i) {
    const std::string free =
        i == 1 ? wanted.string()
               : fmt::format("{}-{}{}", wanted.stem().string(), i, wanted.extension().string());
    std::error_code ec;
    if (fs::copy_file(file, folder / free, ec)) return fmt::format("{}/{}", kPictureFolder, free);
    if (!fs::exists(fs::symlink_status(folder / free)))
      throw Error(Errc::internal, fmt::format("{}/{}", kPictureFolder, free),
                  "the picture cannot be stored: " + ec.message());
  }
}

std::vector<fs::path> Workspace::scenes() const {
  std::vector<fs::path> found = sorted_files(gallery_, ".toml");
  std::erase_if(found, [](const fs::path& f) { return f.filename() == kGalleryIndex; });
  return found;
}

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
    if (names.size() < kMostRuns) names.push_back(std::move(name));
  return names;
}

}  // namespace faba
