#include "server/api.h"

#include <fmt/chrono.h>
#include <fmt/format.h>

#include <atomic>
#include <mutex>

#include "app/recording/session.h"
#include "app/run/notes.h"
#include "app/scenario/read_scenario.h"
#include "app/scenario/scenario.h"
#include "app/scenario/scenario_schema.h"
#include "core/file.h"
#include "server/embedded_page.h"
#include "server/recorded_run.h"
#include "server/request_values.h"
#include "study/pages/drop_report.h"
#include "study/pages/scale_report.h"
#include "study/pages/thumbnail.h"

namespace faba {
namespace {

namespace fs = std::filesystem;

WebResponse json_answer(const Json& j) { return {.body = j.dump()}; }
WebResponse failure(int status, const Error& e) {
  return {.status = status, .body = Json{{"ok", false}, {"where", e.where()}, {"what", e.reason()}}.dump()};
}

const char* type_of(const fs::path& file) {
  static const std::map<std::string, const char*> kTypes = {{".html", "text/html; charset=utf-8"},
                                                            {".js", "text/javascript; charset=utf-8"},
                                                            {".css", "text/css; charset=utf-8"},
                                                            {".svg", "image/svg+xml"},
                                                            {".png", "image/png"},
                                                            {".mp4", "video/mp4"},
                                                            {".json", "application/json"},
                                                            {".csv", "text/csv; charset=utf-8"},
                                                            {".toml", "text/plain; charset=utf-8"},
                                                            {".h5", "application/x-hdf5"},
                                                            {".avi", "video/x-msvideo"}};
  const auto it = kTypes.find(file.extension().string());
  return it == kTypes.end() ? "application/octet-stream" : it->second;
}

// The path without its prefix; empty if the path does not start with the prefix.
std::optional<std::string> below(const std::string& path, std::string_view prefix) {
  if (!path.starts_with(prefix)) return {};
  return path.substr(prefix.size());
}

std::uint64_t number(const WebRequest& r, const char* key, std::uint64_t fallback) {
  const auto it = r.query.find(key);
  return it == r.query.end() ? fallback : std::strtoull(it->second.c_str(), nullptr, 10);
}

// The comment at the top of a scene.
std::string about(const fs::path& scene) {
  std::string text;
  std::istringstream in(read_file(scene));
  for (std::string line; std::getline(in, line) && line.starts_with("#");)
    text += (text.empty() ? "" : " ") + line.substr(std::min(line.find_first_not_of("# "), line.size()));
  return text;
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

// report_scale_picture() without the name of the temporary file in its errors.
PictureScale scale_of_taken(const fs::path& taken, double tick_m, const fs::path& shown) {
  try {
    return report_scale_picture(taken, tick_m, shown);
  } catch (const Error& e) {
    throw Error(e.code(), "", e.reason());
  }
}

}  // namespace

Api::Api(const Workspace& workspace, JobList& jobs, fs::path pictures, fs::path pages)
    : workspace_(workspace),
      jobs_(jobs),
      pictures_(std::move(pictures)),
      pages_(std::move(pages)),
      parts_(builtin_parts()) {}

WebResponse Api::answer(const WebRequest& r) {
  try {
    return route(r);
  } catch (const Error& e) {
    return failure(e.code() == Errc::input ? 404 : e.code() == Errc::usage ? 422 : 500, e);
  } catch (const Json::exception&) {
    return failure(422, {Errc::usage, "invalid request", "a value has the wrong type"});
  } catch (const std::exception& e) {
    return failure(500, {Errc::internal, "", e.what()});
  }
}

WebResponse Api::route(const WebRequest& r) {
  const std::string& p = r.path;
  const bool get = r.method == "GET" || r.method == "HEAD";
  if (get) {
    if (p == "/api/about") return json_answer({{"version", FABA_VERSION}, {"workspace", workspace_.root()}});
    if (p == "/api/schema") return json_answer(scenario_json_schema(parts_));
    if (p == "/api/scenes") return json_answer(scenes());
    if (p == "/api/files") return json_answer(workspace_.files());
    if (p == "/api/jobs") {
      Json all = Json::array();
      for (const Job& j : jobs_.jobs()) all.push_back(job_json(j));
      return json_answer(all);
    }
    if (const auto rest = below(p, "/api/scenes/")) return scene(*rest);
    if (p == "/api/bench") return json_answer(bench_.state());
    if (p == "/api/bench/picture.png") {
      const std::string picture = bench_.picture();
      return {.status = picture.empty() ? 204 : 200, .type = "image/png", .body = picture};
    }
    if (p == "/api/runs" || p.starts_with("/api/runs/"))
      return run(r, p.substr(std::min(p.size(), std::size_t(10))));
    if (const auto rest = below(p, "/api/uploads/")) {
      const fs::path file = pictures_ / fs::path(*rest).filename();
      if (!fs::exists(file)) throw Error(Errc::input, *rest, "file not found");
      return {.type = type_of(file), .body = {}, .file = file};
    }
    if (const auto rest = below(p, "/runs/")) {  // pages written by jobs
      const fs::path file = workspace_.existing("runs/" + *rest);
      return {.type = type_of(file), .body = {}, .file = file, .keep = false, .report = true};
    }
    if (!p.starts_with("/api/")) return page_file(p == "/" ? "index.html" : p.substr(1));
  }
  if (r.method == "POST") {
    if (p == "/api/check") return json_answer(check(body_of(r)));
    if (p == "/api/upload") return json_answer(take_upload(r));
    if (p == "/api/jobs") return json_answer(start_job(body_of(r)));
    if (const auto rest = below(p, "/api/bench/")) return json_answer(bench(body_of(r), *rest));
  }
  if (r.method == "DELETE")
    if (const auto rest = below(p, "/api/jobs/")) {
      if (!jobs_.cancel(std::atoi(rest->c_str()))) throw Error(Errc::input, *rest, "job not found");
      return json_answer(Json::object());
    }
  throw Error(Errc::input, p, "not found");
}

WebResponse Api::page_file(Rest name) {
  if (!pages_.empty()) {
    const fs::path file = pages_ / fs::path(name).filename();
    if (!fs::is_regular_file(file)) throw Error(Errc::input, name, "not found");
    return {.type = type_of(file), .body = {}, .file = file};
  }
  const auto content = embedded_page(name);
  if (!content) throw Error(Errc::input, name, "not found");
  return {.type = type_of(name), .body = std::string(*content)};
}

Json Api::scenes() const {
  Json all = Json::array();
  for (const fs::path& file : workspace_.scenes()) {
    Json one = {{"name", file.stem()}, {"file", "scenes/" + file.filename().string()}};
    try {
      const Scenario s = read_scenario(read_toml(file), parts_);
      std::uint64_t cells = 0;
      for (const Swarm& swarm : s.swarms) cells += swarm.params.count;
      one.update({{"title", s.params.title},
                  {"about", about(file)},
                  {"cells", cells},
                  {"bench", s.rig.has_value()}});
    } catch (const Error& e) {
      one.update({{"title", file.stem()}, {"error", e.what()}});
    }
    all.push_back(one);
  }
  return all;
}

WebResponse Api::scene(Rest rest) {
  const auto slash = rest.find('/');
  const std::string name = rest.substr(0, slash);
  const fs::path file = workspace_.scene(name);
  if (slash == std::string::npos) {
    const Scenario s = read_scenario(read_toml(file), parts_);
    return json_answer({{"name", name},
                        {"file", "scenes/" + name + ".toml"},
                        {"toml", read_file(file)},
                        {"scenario", s.resolved()}});
  }
  if (rest.substr(slash + 1) != "picture.png") throw Error(Errc::input, rest, "not found");
  return {.type = "image/png", .body = {}, .file = picture_of(file), .keep = true};
}

// Rendered again only if the scene file has changed.
fs::path Api::picture_of(const fs::path& scene) {
  const auto changed = fs::last_write_time(scene).time_since_epoch().count();
  fs::path file = pictures_ / fmt::format("scene-{}-{}.png", scene.stem().string(), changed);
  static std::mutex one_at_a_time;
  const std::lock_guard lock(one_at_a_time);
  if (!fs::exists(file)) write_scene_thumbnail(read_scenario(read_toml(scene), parts_), file);
  return file;
}

WebResponse Api::run(const WebRequest& r, Rest rest) {
  if (rest.empty()) {
    Json all = Json::array();
    for (const std::string& name : workspace_.runs()) {
      const fs::path dir = workspace_.existing("runs/" + name);
      try {
        all.push_back(run_card(name, dir));
      } catch (const Json::exception&) {  // an invalid manifest must not hide the other runs
        continue;
      }
    }
    return json_answer(all);
  }
  const auto slash = rest.find('/');
  if (slash == std::string::npos) throw Error(Errc::input, rest, "not found");
  const std::string name = rest.substr(0, slash), what = rest.substr(slash + 1);
  const fs::path dir = workspace_.existing("runs/" + name);
  if (what == "about") return json_answer(describe_run(dir));
  if (what == "scenario")
    return json_answer(
        {{"file", "runs/" + name + "/scenario.toml"},
         {"scenario", read_scenario(read_toml(dir / run_files::kScenario), parts_).resolved()}});
  if (what == "frames")
    return {.type = "application/octet-stream",
            .body = run_frames(dir, number(r, "from", 0), number(r, "count", 1))};
  if (what == "picture.png") {
    const fs::path file =
        pictures_ / fmt::format("run-{}-{}.png", name, fs::last_write_time(dir).time_since_epoch().count());
    if (!fs::exists(file)) write_run_thumbnail(dir, file);
    return {.type = "image/png", .body = {}, .file = file, .keep = true};
  }
  const fs::path file = workspace_.existing("runs/" + name + "/" + what);
  if (fs::is_directory(file)) throw Error(Errc::input, what, "is a folder, not a file");
  return {
      .type = type_of(file), .body = {}, .file = file, .keep = false, .report = file.extension() == ".html"};
}

Json Api::check(const Json& asked) const {
  Document d;
  try {
    if (asked.contains("toml"))
      d = parse_toml(text_of(asked, "toml"), file_name_of(asked));
    else if (asked.contains("scenario") && asked["scenario"].is_object())
      d = workspace_.page_document(asked["scenario"]);
    else
      throw Error(Errc::usage, "scenario", "missing; it must be an object");
    workspace_.check_files(d.root);
    const Scenario s = read_scenario(d, parts_);
    Pool pool(1);
    const Simulation simulation(s, s.params.seed.value_or(1), pool);
    return {{"ok", true},
            {"resolved", s.resolved()},
            {"toml", to_toml(s.resolved())},
            {"notes", scenario_notes(s, simulation, workspace_.root())}};
  } catch (const Error& e) {
    return {{"ok", false}, {"where", workspace_.in_page(e.where())}, {"what", e.reason()}};
  }
}

Json Api::take_upload(const WebRequest& r) {
  static std::atomic<unsigned> number{0};
  const auto named = r.query.find("name");
  const std::string name = named == r.query.end() ? "picture" : fs::path(named->second).filename().string();
  const std::string shown = fmt::format("upload-{}.png", ++number);
  try {
    Json j = drop_json(report_proposed_drop(r.upload, name, pictures_ / shown));
    j["picture"] = name;
    j["url"] = "/api/uploads/" + shown;
    return j;
  } catch (const Error& e) {
    if (e.code() != Errc::input) throw;
    throw Error(Errc::usage, name, e.reason());  // replaces the name of the temporary file
  }
}

// Requests for the camera of a bench.
Json Api::bench(const Json& asked, Rest what) {
  if (what == "open") {
    const std::string name = text_of(asked, "scene");
    Document d = read_toml(workspace_.scene(name));
    d.set("camera.sensor", Json("frames"), "bench");
    bench_.open(read_scenario(d, parts_), name);
  } else if (what == "close") {
    bench_.close();
  } else if (what == "control") {
    std::optional<bool> automatically;
    if (asked.contains("automatically") && asked["automatically"].is_boolean())
      automatically = asked["automatically"].get<bool>();
    bench_.set(text_of(asked, "name"), asked.value("value", 0.0), automatically);
  } else if (what == "ruler") {
    return measure_ruler(asked);
  } else {
    throw Error(Errc::input, what, "not found");
  }
  return bench_.state();
}

// Measures the image scale of an objective in the present camera image of a ruler; saved in calibrations/.
Json Api::measure_ruler(const Json& asked) {
  static std::atomic<unsigned> number{0};
  const std::string objective = text_of(asked, "objective");
  constexpr const char* kAllowed = "abcdefghijklmnopqrstuvwxyzABCDEFGHIJKLMNOPQRSTUVWXYZ0123456789-_. ";
  if (objective.find_first_not_of(kAllowed) != std::string::npos || objective.front() == '.')
    throw Error(Errc::usage, "objective",
                "invalid name; it must consist of letters, digits, spaces, dots, underscores and dashes, "
                "such as 10x");
  const double tick_um = asked.value("tick_um", 0.0);
  if (!(tick_um >= 1e-3 && tick_um <= 1e6))
    throw Error(
        Errc::usage, "tick_um",
        fmt::format("{:g} is out of range; the distance between marks must be between 0.001 and 1e6 um",
                    tick_um));
  const std::string name = "calibrations/" + objective;
  const fs::path picture = workspace_.inside(name + ".png"), file = workspace_.inside(name + ".toml");
  const std::string shown = fmt::format("ruler-{}.png", ++number);
  fs::create_directories(picture.parent_path());
  const fs::path taken = pictures_ / fmt::format("ruler-taken-{}.png", number.load());
  const std::string now = bench_.picture();
  if (now.empty()) throw Error(Errc::input, "bench", "no image from the camera");
  write_file(taken, now);
  const PictureScale scale = scale_of_taken(taken, 1e-6 * tick_um, pictures_ / shown);
  Json j = scale_json(scale);
  j["url"] = "/api/uploads/" + shown;
  if (quality_of(scale.warnings) == Quality::poor) return j;  // displayed, but not saved
  fs::copy_file(taken, picture, fs::copy_options::overwrite_existing);
  Calibration c = calibration_of(scale);
  c.source = picture.filename().string();
  write_calibration(file, c);
  j["file"] = name + ".toml";
  return j;
}

Json Api::start_job(const Json& asked) {
  const std::string verb = text_of(asked, "verb");
  static std::atomic<unsigned> number{0};
  const std::string stamp = fmt::format("{:%Y%m%d-%H%M%S}-{}", fmt::localtime(std::time(nullptr)), ++number);
  const auto file = [&](const char* key) {
    const std::string name = text_of(asked, key);
    (void)workspace_.existing(name);  // a leading dash would be an option
    return "./" + name;
  };
  const auto page = [&](const std::string& what) { return fmt::format("runs/{}-{}.html", what, stamp); };
  fs::create_directories(workspace_.root() / "runs");
  std::vector<std::string> words;
  std::string out;
  if (verb == "activity") {
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
  return {{"id", jobs_.add(title, words, out, out)}};
}

}  // namespace faba
