#include <fmt/format.h>

#include <cstdlib>

#include "app/recording/session.h"
#include "app/scenario/read_scenario.h"
#include "app/scenario/scenario.h"
#include "core/error.h"
#include "core/file.h"
#include "server/api/lab_services.h"
#include "server/api/responses.h"
#include "server/files/opened_input.h"
#include "server/recorded_run.h"
#include "server/request_values.h"
#include "study/pages/thumbnail.h"

namespace faba {
namespace {

namespace fs = std::filesystem;

Json scenario_of(const LabServices& lab, const std::string& name, const fs::path& dir) {
  return {{"file", "runs/" + name + "/scenario.toml"},
          {"scenario", read_scenario(read_toml(dir / run_files::kScenario), lab.parts).resolved()}};
}

WebResponse picture(const LabServices& lab, const std::string& name, const fs::path& dir) {
  const auto changed = fs::last_write_time(dir / run_files::kManifest).time_since_epoch().count();
  fs::path file = lab.pictures / fmt::format("run-{}-{}.png", name, changed);
  if (!fs::exists(file)) write_run_thumbnail(dir, file);
  return picture_answer(file);
}

// A file of a run, or a page that a job has written.
WebResponse output(const LabServices& lab, const std::string& name) {
  const fs::path file = lab.workspace.existing("runs/" + name);
  if (fs::is_directory(file)) throw Error(Errc::input, name, "is a folder, not a file");
  return output_answer(file);
}

void add_changes(Routes& routes, const LabServices& lab) {
  routes.add("GET", "/api/runs/*/size", [&lab](const auto&, const auto& names) {
    return json_answer({{"bytes", lab.runs.size(names[0])}});
  });
  routes.add("DELETE", "/api/runs/*", [&lab](const auto&, const auto& names) {
    return json_answer(trash_item_json(lab.runs.remove(names[0])));
  });
  routes.add("POST", "/api/runs/*/rename", [&lab](const auto& r, const auto& names) {
    return json_answer({{"name", lab.runs.rename(names[0], text_of(body_of(r), "to"))}});
  });
  routes.add("POST", "/api/runs/*/tags", [&lab](const auto& r, const auto& names) {
    lab.runs.set_tags(names[0], body_of(r));
    return json_answer(Json::object());
  });
}

}  // namespace

void add_run_routes(Routes& routes, const LabServices& lab) {
  // Calls a function with the folder of a run.
  const auto with = [&lab](const std::string& name, const auto& use) {
    return with_opened(lab.workspace.existing("runs/" + name), "runs/" + name, use);
  };
  routes.add("GET", "/api/runs", [&lab](const auto&, const auto&) { return json_answer(lab.runs.list()); });
  add_changes(routes, lab);
  routes.add("GET", "/api/runs/*/about",
             [with](const auto&, const auto& names) { return json_answer(with(names[0], describe_run)); });
  routes.add("GET", "/api/runs/*/scenario", [&lab, with](const auto&, const auto& names) {
    return json_answer(with(names[0], [&](const fs::path& dir) { return scenario_of(lab, names[0], dir); }));
  });
  routes.add("GET", "/api/runs/*/frames", [with](const auto& r, const auto& names) {
    return WebResponse{.type = "application/octet-stream", .body = with(names[0], [&](const fs::path& dir) {
                                                             return run_frames(dir, query_count(r, "from", 0),
                                                                               query_count(r, "count", 1));
                                                           })};
  });
  routes.add("GET", "/api/runs/*/picture.png", [&lab, with](const auto&, const auto& names) {
    return with(names[0], [&](const fs::path& dir) { return picture(lab, names[0], dir); });
  });
  for (const char* pattern : {"/api/runs/**", "/runs/**"})
    routes.add("GET", pattern, [&lab](const auto&, const auto& names) { return output(lab, names[0]); });
}

}  // namespace faba
