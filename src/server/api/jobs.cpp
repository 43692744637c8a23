#include <fmt/chrono.h>
#include <fmt/format.h>

#include <atomic>
#include <cstdlib>

#include "core/error.h"
#include "server/api/lab_services.h"
#include "server/api/responses.h"
#include "server/request_values.h"

namespace faba {
namespace {

namespace fs = std::filesystem;

Json start_job(const LabServices& lab, const Json& asked) {
  const std::string verb = text_of(asked, "verb");
  static std::atomic<unsigned> number{0};
  const std::string stamp = fmt::format("{:%Y%m%d-%H%M%S}-{}", fmt::localtime(std::time(nullptr)), ++number);
  const auto file = [&](const char* key) {
    const std::string name = text_of(asked, key);
    (void)lab.workspace.existing(name);  // a leading dash would be an option
    return "./" + name;
  };
  const auto page = [&](const std::string& what) { return fmt::format("runs/{}-{}.html", what, stamp); };
  fs::create_directories(lab.workspace.root() / "runs");
  std::vector<std::string> words;
  std::string out;
  if (verb == "activity" && asked.contains("experiment")) {
    const std::string name = text_of(asked, "experiment");
    const fs::path folder = fs::relative(lab.experiments.folder(name), lab.workspace.root());
    fs::create_directories(lab.workspace.root() / folder / "results");
    out = folder / fmt::format("results/activity-{}.html", stamp);
    words = {"activity", "./" + folder.string(), "--report", out, "--json"};
  } else if (verb == "activity") {
    out = page("activity");
    words = {"activity", file("video"), "--report", out, "--json"};
    if (const std::string d = asked.value("direction", ""); !d.empty()) {
      if (d.find_first_not_of("0123456789.-+") != std::string::npos)
        throw Error(Errc::usage, "direction", "must be a number, in degrees");
      words.insert(words.begin() + 2, {"--direction", d});
    }
  } else if (verb == "compare") {
    out = page("compare");
    words = {"compare", file("reference"), file("video"), "--report", out, "--json"};
  } else if (verb == "identify" || verb == "compare-controllers") {
    const std::string study = file("study"),
                      dir = fmt::format("runs/{}-{}", fs::path(study).stem().string(), stamp);
    out = dir + (verb == "identify" ? "/identify.html" : "/report.html");
    words = {verb, study, "--out", dir, "--json"};
  } else if (verb == "field map") {
    out = fmt::format("runs/field-{}.png", stamp);
    words = {"field", "map", file("rig"), "--picture", out, "--json"};
    // Without the key the default currents of the coil system are used.
    if (asked.contains("current"))
      words.insert(words.begin() + 3, "--current=" + numbers_of(asked, "current"));
  } else {
    throw Error(
        Errc::usage, "verb",
        fmt::format("\"{}\" is not one of activity, compare, identify, compare-controllers, field map",
                    verb));
  }
  const std::string& about = verb == "field map" ? words[2] : words[1];
  const std::string title = fmt::format("{}: {}", verb, fs::path(about).filename().string());
  return {{"id", lab.jobs.add(title, words, out, out)}};
}

Json jobs(const LabServices& lab) {
  Json all = Json::array();
  for (const Job& j : lab.jobs.jobs()) all.push_back(job_json(j));
  return all;
}

}  // namespace

void add_job_routes(Routes& routes, const LabServices& lab) {
  routes.add("GET", "/api/files",
             [&lab](const auto&, const auto&) { return json_answer(lab.workspace.files()); });
  routes.add("GET", "/api/jobs", [&lab](const auto&, const auto&) { return json_answer(jobs(lab)); });
  routes.add("POST", "/api/jobs",
             [&lab](const auto& r, const auto&) { return json_answer(start_job(lab, body_of(r))); });
  routes.add("DELETE", "/api/jobs/*", [&lab](const auto&, const auto& names) {
    if (!lab.jobs.cancel(std::atoi(names[0].c_str()))) throw Error(Errc::input, names[0], "job not found");
    return json_answer(Json::object());
  });
}

}  // namespace faba
