#include <fmt/format.h>

#include <algorithm>
#include <array>

#include "app/scenario/read_scenario.h"
#include "app/scenario/scenario.h"
#include "core/error.h"
#include "core/file.h"
#include "core/json_input.h"
#include "core/toml.h"
#include "server/api/lab_services.h"
#include "server/api/responses.h"
#include "server/request_values.h"

namespace faba {
namespace {

namespace fs = std::filesystem;

constexpr const char* kBestScene = "best.toml";
constexpr std::size_t kMostResultFiles = 200;

std::string in_workspace(const LabServices& lab, const fs::path& file) {
  return file.lexically_relative(lab.workspace.root()).generic_string();
}

// A result is named by its page, a file below runs/ or below the results of an experiment:
// "runs/study/report.html".
fs::path page_of(const LabServices& lab, const std::string& name) {
  fs::path page = lab.workspace.existing(name);
  const fs::path relative = page.lexically_relative(lab.workspace.root());
  const std::vector<fs::path> parts(relative.begin(), relative.end());
  const bool run = parts.size() > 1 && parts[0] == "runs";
  const bool experiment = parts.size() > 3 && parts[0] == "experiments" && parts[2] == "results";
  if (!fs::is_regular_file(page) || (!run && !experiment))
    throw Error(Errc::usage, name,
                "is not a result; it must be a file below runs/ or experiments/NAME/results/");
  return page;
}

// The files of a result: those in its folder, or beside a page in runs/ those with the name of the page.
Json files_of(const LabServices& lab, const fs::path& page) {
  constexpr std::array<const char*, 8> kKinds = {".csv", ".json", ".toml", ".png",
                                                 ".svg", ".html", ".h5",   ".mp4"};
  const bool alone = page.parent_path() == lab.workspace.root() / "runs";
  std::vector<fs::path> found;
  for (const auto& e : fs::directory_iterator(page.parent_path())) {
    const fs::path& file = e.path();
    if (!e.is_regular_file() || e.is_symlink() || file.filename().string().starts_with('.')) continue;
    if (file.filename() == "job.json") continue;  // of the list of jobs
    if (alone && file.stem() != page.stem()) continue;
    const bool known = std::find(kKinds.begin(), kKinds.end(), file.extension()) != kKinds.end();
    if (known && found.size() < kMostResultFiles) found.push_back(file);
  }
  std::sort(found.begin(), found.end());
  Json files = Json::array();
  for (const fs::path& file : found)
    files.push_back({{"file", in_workspace(lab, file)}, {"bytes", fs::file_size(file)}});
  return files;
}

// The first video of an identification in the workspace, from the provenance of its result; empty: none.
std::string video_of(const LabServices& lab, const fs::path& page) {
  const fs::path file = page.parent_path() / "identify.json";
  if (!fs::is_regular_file(file)) return {};
  const Json result = parse_json(read_file(file));
  if (!result.is_object()) return {};
  const Json inputs = result.value("/provenance/inputs"_json_pointer, Json::array());
  for (std::size_t i = 1; i < inputs.size(); ++i) {  // the first is the study
    const fs::path video = fs::weakly_canonical(lab.workspace.root() / inputs[i].value("path", ""));
    try {
      std::string name = in_workspace(lab, video);
      (void)lab.workspace.existing(name);
      return name;
    } catch (const Error&) {
      continue;  // outside of the workspace, or deleted
    }
  }
  return {};
}

fs::path scene_of(const LabServices& lab, const std::string& name) {
  const fs::path scene = page_of(lab, name).parent_path() / kBestScene;
  return lab.workspace.existing(in_workspace(lab, scene));
}

Json about_result(const LabServices& lab, const std::string& name) {
  const fs::path page = page_of(lab, name);
  const bool scene = fs::is_regular_file(page.parent_path() / kBestScene);
  return {{"files", files_of(lab, page)},
          {"scene", scene ? in_workspace(lab, page.parent_path() / kBestScene) : ""},
          {"video", scene ? video_of(lab, page) : ""}};
}

Json best_scenario(const LabServices& lab, const std::string& name) {
  const fs::path file = scene_of(lab, name);
  return {{"file", in_workspace(lab, file)},
          {"scenario", read_scenario(read_toml(file), lab.parts).resolved()}};
}

// Two jobs: a run of the best model, and its comparison with the video that the model was identified from.
Json compare_with_video(const LabServices& lab, const Json& asked) {
  const std::string name = text_of(asked, "page");
  const fs::path page = page_of(lab, name);
  const std::string scene = in_workspace(lab, scene_of(lab, name)), video = video_of(lab, page);
  if (video.empty())
    throw Error(Errc::usage, name,
                "has no video in the folder of the lab; copy the video there and identify it again");
  const std::string stem = in_workspace(lab, page.parent_path());
  std::string run, report;
  int number = 0;
  const auto queued = [&](const Job& j) { return j.page == report && j.state <= Job::State::running; };
  const auto taken = [&] {
    const std::vector<Job> jobs = lab.jobs.jobs();
    return fs::exists(lab.workspace.root() / run) || fs::exists(lab.workspace.root() / report) ||
           std::any_of(jobs.begin(), jobs.end(), queued);
  };
  do {
    ++number;
    run = fmt::format("{}-best-{}", stem, number);
    report = fmt::format("{}-compared-{}.html", stem, number);
  } while (taken());
  lab.jobs.add({.title = "run: " + run,
                .words = {"run", "./" + scene, "--seed", "1", "--out", run, "--json"},
                .page = run + "/report.html",
                .out = run});
  const int id = lab.jobs.add({.title = "compare: " + fs::path(video).filename().string(),
                               .words = {"compare", "./" + video, run, "--report", report, "--json"},
                               .page = report,
                               .out = report});
  return {{"id", id}, {"page", report}};
}

std::string page_in(const WebRequest& r) {
  std::string page = query_text(r, "page");
  if (page.empty())
    throw Error(Errc::usage, "page", "missing; it must be a file below runs/ or experiments/");
  return page;
}

// A file of a result of an experiment; runs.cpp has those below runs/.
WebResponse result_file(const LabServices& lab, const std::string& experiment, const std::string& name) {
  return output_answer(page_of(lab, "experiments/" + experiment + "/results/" + name));
}

}  // namespace

void add_result_routes(Routes& routes, const LabServices& lab) {
  routes.add("GET", "/api/results",
             [&lab](const auto& r, const auto&) { return json_answer(about_result(lab, page_in(r))); });
  routes.add("GET", "/api/results/scene",
             [&lab](const auto& r, const auto&) { return json_answer(best_scenario(lab, page_in(r))); });
  routes.add("GET", "/experiments/*/results/**",
             [&lab](const auto&, const auto& names) { return result_file(lab, names[0], names[1]); });
  routes.add("POST", "/api/results/compare",
             [&lab](const auto& r, const auto&) { return json_answer(compare_with_video(lab, body_of(r))); });
}

}  // namespace faba
