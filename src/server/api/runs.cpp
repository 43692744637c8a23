#include <fmt/format.h>

#include <cstdlib>

#include "app/recording/run_lock.h"
#include "app/recording/session.h"
#include "app/scenario/read_scenario.h"
#include "app/scenario/scenario.h"
#include "core/error.h"
#include "core/file.h"
#include "server/api/lab_services.h"
#include "server/api/responses.h"
#include "server/recorded_run.h"
#include "study/pages/thumbnail.h"

namespace faba {
namespace {

namespace fs = std::filesystem;

std::uint64_t number(const WebRequest& r, const char* key, std::uint64_t fallback) {
  const auto it = r.query.find(key);
  return it == r.query.end() ? fallback : std::strtoull(it->second.c_str(), nullptr, 10);
}

// One entry of the list of runs. Throws Json::exception for a manifest that is not JSON or has a value of the
// wrong type.
Json run_card(const std::string& name, const fs::path& dir) {
  const Json m = Json::parse(read_file(dir / run_files::kManifest));
  Json files = Json::array();
  for (const char* file : {"series.csv", "tracks.h5", "video.mp4", "video.avi", "flow.h5", "report.html"})
    if (fs::exists(dir / file)) files.push_back(file);
  return {{"name", name},
          {"title", m.value("title", "")},
          {"complete", m.value("complete", false) && !RunLock::marks(dir)},
          {"frames", m.value("frames", 0)},
          {"duration_s", m.value("duration_s", 0.0)},
          {"seed", m.contains("seed") ? m["seed"].dump() : ""},
          {"state_hash", m.value("state_hash", "")},
          {"files", files}};
}

Json runs(const LabServices& lab) {
  Json all = Json::array();
  for (const std::string& name : lab.workspace.runs()) {
    const fs::path dir = lab.workspace.existing("runs/" + name);
    try {
      all.push_back(run_card(name, dir));
    } catch (const Json::exception&) {  // an invalid manifest must not hide the other runs
      continue;
    }
  }
  return all;
}

Json scenario_of(const LabServices& lab, const std::string& name, const fs::path& dir) {
  return {{"file", "runs/" + name + "/scenario.toml"},
          {"scenario", read_scenario(read_toml(dir / run_files::kScenario), lab.parts).resolved()}};
}

WebResponse picture(const LabServices& lab, const std::string& name, const fs::path& dir) {
  const auto changed = fs::last_write_time(dir).time_since_epoch().count();
  fs::path file = lab.pictures / fmt::format("run-{}-{}.png", name, changed);
  if (!fs::exists(file)) write_run_thumbnail(dir, file);
  return picture_answer(file);
}

// A file of a run, or a page that a job has written.
WebResponse output(const LabServices& lab, const std::string& name) {
  const fs::path file = lab.workspace.existing("runs/" + name);
  if (fs::is_directory(file)) throw Error(Errc::input, name, "is a folder, not a file");
  WebResponse answer = file_answer(file);
  answer.report = file.extension() == ".html";
  return answer;
}

}  // namespace

void add_run_routes(Routes& routes, const LabServices& lab) {
  const auto dir = [&lab](const std::string& name) { return lab.workspace.existing("runs/" + name); };
  routes.add("GET", "/api/runs", [&lab](const auto&, const auto&) { return json_answer(runs(lab)); });
  routes.add("GET", "/api/runs/*/about",
             [dir](const auto&, const auto& names) { return json_answer(describe_run(dir(names[0]))); });
  routes.add("GET", "/api/runs/*/scenario", [&lab, dir](const auto&, const auto& names) {
    return json_answer(scenario_of(lab, names[0], dir(names[0])));
  });
  routes.add("GET", "/api/runs/*/frames", [dir](const auto& r, const auto& names) {
    return WebResponse{.type = "application/octet-stream",
                       .body = run_frames(dir(names[0]), number(r, "from", 0), number(r, "count", 1))};
  });
  routes.add("GET", "/api/runs/*/picture.png",
             [&lab, dir](const auto&, const auto& names) { return picture(lab, names[0], dir(names[0])); });
  for (const char* pattern : {"/api/runs/**", "/runs/**"})
    routes.add("GET", pattern, [&lab](const auto&, const auto& names) { return output(lab, names[0]); });
}

}  // namespace faba
