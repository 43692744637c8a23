#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <atomic>
#include <ctime>

#include "core/error.h"
#include "core/file.h"
#include "core/monotonic.h"
#include "server/api/lab_services.h"
#include "server/api/responses.h"
#include "server/api/rulers.h"
#include "server/request_values.h"

namespace faba {
namespace {

namespace fs = std::filesystem;

// Measures the image scale of an objective in the present camera image of a ruler; saved in calibrations/.
Json measure_objective(const LabServices& lab, const Json& asked) {
  static std::atomic<unsigned> number{0};
  const std::string objective = text_of(asked, "objective");
  constexpr const char* kAllowed = "abcdefghijklmnopqrstuvwxyzABCDEFGHIJKLMNOPQRSTUVWXYZ0123456789-_. ";
  if (objective.find_first_not_of(kAllowed) != std::string::npos || objective.front() == '.')
    throw Error(Errc::usage, "objective",
                "invalid name; it must consist of letters, digits, spaces, dots, underscores and dashes, "
                "such as 10x");
  const std::string now = lab.bench.png();
  if (now.empty()) throw Error(Errc::input, "bench", "no image from the camera");
  const fs::path taken = lab.pictures / fmt::format("ruler-taken-{}.png", ++number);
  write_file(taken, now);
  return measure_ruler(lab, taken, asked.value("tick_um", 0.0), "calibrations/" + objective, ".png");
}

std::string time_stamp() {
  const std::time_t now = std::time(nullptr);
  std::tm local{};
  localtime_r(&now, &local);
  return fmt::format("{:04}{:02}{:02}-{:02}{:02}{:02}", local.tm_year + 1900, local.tm_mon + 1, local.tm_mday,
                     local.tm_hour, local.tm_min, local.tm_sec);
}

// The wanted name of a recording; the same name may be used again.
std::string name_of(const Json& asked, const char* fallback) {
  const std::string name = safe_name(asked.value("name", ""));
  return name.empty() ? fallback : name;
}

// The experiment must exist before anything is recorded.
BenchDestination destination(const LabServices& lab, const Json& asked, const std::string& title) {
  BenchDestination to{.title = title,
                      .root = lab.workspace.root(),
                      .out = {},
                      .experiment = asked.value("experiment", ""),
                      .drop = asked.value("drop", "")};
  if (!to.experiment.empty()) (void)lab.experiments.read(to.experiment);
  return to;
}

void capture(const LabServices& lab, const Json& asked) {
  constexpr double kDay = 86400;  // s
  constexpr std::uint64_t kMostFrames = 1000000000;
  CaptureJob job;
  job.frames = count_of(asked, "frames", 0, kMostFrames, 0);
  job.one_of = count_of(asked, "one_of", 1, kMostFrames, 1);
  job.time = number_of(asked, "time_s", 0, 7 * kDay, 0);
  job.every = number_of(asked, "every_s", 0, kDay, 0);
  job.buffered = asked.value("buffered", false);
  job.only_corrupt = asked.value("only_corrupt", false);
  job.format = asked.value("format", "avi");
  constexpr std::array kFormats = {"avi", "mp4", "png", "pgm", "ppm", "tiff"};
  if (std::ranges::find(kFormats, job.format) == kFormats.end())
    throw Error(
        Errc::usage, "format",
        fmt::format("\"{}\" is not a format; choose one of {}", job.format, fmt::join(kFormats, ", ")));
  if (job.every > 0 && job.one_of > 1)
    throw Error(Errc::usage, "every_s", "cannot be combined with one_of; choose one of them");
  const std::string name = name_of(asked, "capture");
  BenchDestination to = destination(lab, asked, name);
  const bool video = job.format == "avi" || job.format == "mp4";
  const fs::path folder =
      to.experiment.empty() ? lab.workspace.inside("captures") : lab.experiments.video_folder(to.experiment);
  fs::create_directories(folder);
  const std::string stem = fmt::format("{}-{}", name, time_stamp());
  const std::string extension = video ? "." + job.format : "";
  to.out = folder / (stem + extension);
  for (int i = 2; fs::exists(to.out); ++i) to.out = folder / fmt::format("{}-{}{}", stem, i, extension);
  lab.bench.capture(job, to);
}

std::uint64_t page_of(const Json& asked) { return asked.value("page", std::uint64_t(0)); }

void run(const LabServices& lab, const Json& asked) {
  constexpr double kLongest = 1e5;  // s
  const std::string name = name_of(asked, "bench");
  BenchDestination to = destination(lab, asked, name);
  to.out = lab.workspace.inside("runs/" + name);
  fs::create_directories(to.out.parent_path());
  const double duration = number_of(asked, "duration_s", 0.1, kLongest, 20);
  lab.bench.run(duration, to, page_of(asked), text_of(asked, "permit"));
}

void step_responses(const LabServices& lab, const Json& asked) {
  const std::string name = name_of(asked, "step-responses");
  BenchDestination to = destination(lab, asked, name);
  to.out = lab.workspace.inside("runs/" + name);
  fs::create_directories(to.out.parent_path());
  Json changes = Json::object();
  const auto add = [&](const char* asked_key, const char* key, const char* unit) {
    if (!asked.contains(asked_key) || asked[asked_key].is_null()) return;
    changes[key] = fmt::format("{} {}", asked[asked_key].get<double>(), unit);
  };
  if (asked.contains("repeat")) changes["repeat"] = count_of(asked, "repeat", 1, 1000);
  add("every_s", "every", "s");
  add("direction_deg", "direction", "deg");
  add("field_ut", "field", "uT");
  add("gather_s", "gather", "s");
  add("before_s", "before", "s");
  add("record_s", "record", "s");
  lab.bench.step_responses(changes, to, page_of(asked), text_of(asked, "permit"));
}

Json jog(const LabServices& lab, const Json& asked) {
  const JogSession s = lab.bench.jog(page_of(asked), text_of(asked, "permit"));
  return {{"session", s.secret}, {"max_a", s.max_current}, {"deadline_s", BenchConsole::kJogDeadline}};
}

Json permit(const LabServices& lab, const Json& asked) {
  const std::string what = text_of(asked, "what");
  constexpr std::array kPurposes = {"run", "step-response", "jog"};
  if (std::ranges::find(kPurposes, what) == kPurposes.end())
    throw Error(
        Errc::usage, "what",
        fmt::format("\"{}\" does not use the coils; choose one of {}", what, fmt::join(kPurposes, ", ")));
  return {{"permit", lab.bench.permits().issue(page_of(asked), what, monotonic_now())},
          {"valid_s", ArmingPermits::kValid}};
}

void open(const LabServices& lab, const Json& asked) {
  const std::string name = text_of(asked, "scene");
  Document d = read_toml(lab.workspace.scene(name));
  d.set("camera.sensor", Json("frames"), "bench");
  lab.bench.open(d, name);
}

void set_control(const LabServices& lab, const Json& asked) {
  std::optional<bool> automatically;
  if (asked.contains("automatically") && asked["automatically"].is_boolean())
    automatically = asked["automatically"].get<bool>();
  lab.bench.set(text_of(asked, "name"), asked.value("value", 0.0), automatically);
}

void set_sample(const LabServices& lab, const Json& asked) {
  constexpr double kLongest = 1e6;  // s
  const bool known = asked.contains("exposure_s") && !asked["exposure_s"].is_null();
  lab.bench.sample(known ? std::optional(number_of(asked, "exposure_s", 0, kLongest)) : std::nullopt);
}

}  // namespace

void add_bench_routes(Routes& routes, const LabServices& lab) {
  routes.add("GET", "/api/bench",
             [&lab](const auto&, const auto&) { return json_answer(lab.bench.state()); });
  const auto picture = [&](const char* path, const char* type, std::string (BenchConsole::*encode)()) {
    routes.add("GET", path, [&lab, type, encode](const auto&, const auto&) {
      const std::string bytes = (lab.bench.*encode)();
      return WebResponse{.status = bytes.empty() ? 204 : 200, .type = type, .body = bytes};
    });
  };
  picture("/api/bench/picture.png", "image/png", &BenchConsole::png);
  picture("/api/bench/picture.bmp", "image/bmp", &BenchConsole::bmp);
  // Requests whose answer is the state.
  const auto act = [&](const char* what, void (*request)(const LabServices&, const Json&)) {
    routes.add("POST", fmt::format("/api/bench/{}", what), [&lab, request](const auto& r, const auto&) {
      request(lab, body_of(r));
      return json_answer(lab.bench.state());
    });
  };
  act("open", open);
  act("close", [](const LabServices& l, const Json&) { l.bench.close(); });
  act("control", set_control);
  act("sample", set_sample);
  act("capture", capture);
  act("run", run);
  act("step-response", step_responses);
  act("stop", [](const LabServices& l, const Json&) { l.bench.stop(); });
  act("off", [](const LabServices& l, const Json&) { l.bench.off(); });
  // Requests with another answer.
  const auto ask = [&](const char* what, Json (*request)(const LabServices&, const Json&)) {
    routes.add("POST", fmt::format("/api/bench/{}", what),
               [&lab, request](const auto& r, const auto&) { return json_answer(request(lab, body_of(r))); });
  };
  ask("ruler", measure_objective);
  ask("permit", permit);
  ask("jog", jog);
  ask("jog/set", [](const LabServices& l, const Json& asked) {
    return l.bench.jog_set(text_of(asked, "session"), asked.value("number", std::uint64_t(0)),
                           asked.at("currents_a").get<std::vector<double>>());
  });
  ask("jog/reset", [](const LabServices& l, const Json& asked) {
    l.bench.jog_reset(text_of(asked, "session"), page_of(asked), text_of(asked, "permit"));
    return Json{{"ok", true}};
  });
}

}  // namespace faba
