#include "server/jobs/input_files.h"

#include <algorithm>
#include <map>

#include "app/recording/session.h"
#include "app/scenario/file_kind.h"
#include "core/error.h"
#include "server/files/file_kinds.h"
#include "server/files/file_time.h"
#include "study/data/run_video.h"
#include "study/experiment/experiment.h"

namespace faba {
namespace {

namespace fs = std::filesystem;
constexpr int kDeepestFolder = 5;
constexpr std::size_t kMostVisited = 50000, kMostListed = 5000;
constexpr std::uintmax_t kLargestStudy = 1u << 20;  // bytes

Json entry(const Workspace& w, const fs::path& file, const char* kind) {
  std::error_code ec;
  const auto bytes = fs::is_regular_file(file, ec) ? fs::file_size(file, ec) : 0;
  return {{"file", file.lexically_relative(w.root()).generic_string()},
          {"kind", kind},
          {"bytes", bytes},
          {"time", modified_s(file)}};
}

void add_coil_system(Json e, const Document& d, std::vector<Json>& found) {
  const Json& coils = d.root["coil"];
  e["kind"] = "coil_system";
  e["coils"] = coils.size();
  e["currents"] =
      std::any_of(coils.begin(), coils.end(), [](const Json& c) { return c.contains("current"); });
  found.push_back(std::move(e));
}

// A configuration file: what it is shows in its keys.
void add_configuration(const Workspace& w, const fs::path& file, std::vector<Json>& found) {
  static const std::map<FileKind, const char*> kVerbs = {{FileKind::identify_study, "identify"},
                                                         {FileKind::activity_study, "activity"},
                                                         {FileKind::controller_study, "compare-controllers"},
                                                         {FileKind::moment_study, "moment"},
                                                         {FileKind::calibration_study, "calibrate"}};
  std::error_code ec;
  if (fs::file_size(file, ec) > kLargestStudy) return;
  try {
    const Document d = read_toml(file);
    const auto kind = file_kind(Node(d));
    if (!kind) return;
    Json e = entry(w, file, "scene");
    if (*kind == FileKind::coil_system) return add_coil_system(std::move(e), d, found);
    if (const auto verb = kVerbs.find(*kind); verb != kVerbs.end()) {
      e["kind"] = "study";
      e["verb"] = verb->second;
      e["title"] = d.root.contains("title") && d.root["title"].is_string() ? d.root["title"] : Json("");
    }
    found.push_back(std::move(e));
  } catch (const Error&) {
    return;  // not a file of this program, or being written
  }
}

void add_experiment(const Workspace& w, const fs::path& folder, const fs::path& file,
                    std::vector<Json>& found) {
  Json e = entry(w, folder, "experiment");
  try {
    e["title"] = read_experiment(file).title;
  } catch (const Error&) {
    e["title"] = "";  // the job reports the error
  }
  found.push_back(std::move(e));
}

struct Search {
  const Workspace& workspace;
  std::vector<Json> found = {};
  std::size_t visited = 0;

  void file(const fs::path& path) {
    if (path.extension() == ".toml" && path.filename() != kExperimentFile)
      return add_configuration(workspace, path, found);
    if (has_picture_extension(path)) found.push_back(entry(workspace, path, "picture"));
    if (has_video_extension(path)) found.push_back(entry(workspace, path, "video"));
    if (has_table_extension(path)) found.push_back(entry(workspace, path, "table"));
  }
  void run(const fs::path& path) {
    try {
      if (!has_camera_video(path)) return;
    } catch (const Error&) {
      return;  // damaged or incomplete
    }
    Json e = entry(workspace, path, "video");
    e["run"] = true;
    found.push_back(std::move(e));
  }
  void folder(const fs::path& path, int depth) {
    std::error_code ec;
    if (const auto experiment = experiment_file(path)) add_experiment(workspace, path, *experiment, found);
    if (depth > kDeepestFolder) return;
    for (const auto& e : fs::directory_iterator(path, ec)) {
      if (++visited > kMostVisited) return;
      if (e.path().filename().string().starts_with('.') || e.is_symlink(ec)) continue;
      if (e.is_regular_file(ec))
        file(e.path());
      else if (e.is_directory(ec) && is_run(e.path()))
        run(e.path());
      else if (e.is_directory(ec) && e.path().filename() != "node_modules")
        folder(e.path(), depth + 1);
    }
  }
};

}  // namespace

Json input_files(const Workspace& workspace) {
  Search search{workspace};
  search.folder(workspace.root(), 1);
  std::sort(search.found.begin(), search.found.end(), [](const Json& a, const Json& b) {
    return std::pair(-a["time"].get<double>(), a["file"].get<std::string>()) <
           std::pair(-b["time"].get<double>(), b["file"].get<std::string>());
  });
  if (search.found.size() > kMostListed) search.found.resize(kMostListed);
  return search.found;
}

}  // namespace faba
