#include <fmt/format.h>

#include <atomic>

#include "app/scenario/read_scenario.h"
#include "app/scenario/scenario.h"
#include "core/error.h"
#include "core/file.h"
#include "server/api/lab_services.h"
#include "server/api/responses.h"
#include "server/request_values.h"
#include "study/pages/scale_report.h"

namespace faba {
namespace {

namespace fs = std::filesystem;

// report_scale_picture() without the name of the temporary file in its errors.
PictureScale scale_of_taken(const fs::path& taken, double tick_m, const fs::path& shown) {
  try {
    return report_scale_picture(taken, tick_m, shown);
  } catch (const Error& e) {
    throw Error(e.code(), "", e.reason());
  }
}

// Measures the image scale of an objective in the present camera image of a ruler; saved in calibrations/.
Json measure_ruler(const LabServices& lab, const Json& asked) {
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
  const fs::path picture = lab.workspace.inside(name + ".png"), file = lab.workspace.inside(name + ".toml");
  const std::string shown = fmt::format("ruler-{}.png", ++number);
  fs::create_directories(picture.parent_path());
  const fs::path taken = lab.pictures / fmt::format("ruler-taken-{}.png", number.load());
  const std::string now = lab.bench.picture();
  if (now.empty()) throw Error(Errc::input, "bench", "no image from the camera");
  write_file(taken, now);
  const PictureScale scale = scale_of_taken(taken, 1e-6 * tick_um, lab.pictures / shown);
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

// Requests for the camera of a bench.
Json control(const LabServices& lab, const Json& asked, const std::string& what) {
  if (what == "open") {
    const std::string name = text_of(asked, "scene");
    Document d = read_toml(lab.workspace.scene(name));
    d.set("camera.sensor", Json("frames"), "bench");
    lab.bench.open(read_scenario(d, lab.parts), name);
  } else if (what == "close") {
    lab.bench.close();
  } else if (what == "control") {
    std::optional<bool> automatically;
    if (asked.contains("automatically") && asked["automatically"].is_boolean())
      automatically = asked["automatically"].get<bool>();
    lab.bench.set(text_of(asked, "name"), asked.value("value", 0.0), automatically);
  } else if (what == "ruler") {
    return measure_ruler(lab, asked);
  } else {
    throw Error(Errc::input, what, "not found");
  }
  return lab.bench.state();
}

}  // namespace

void add_bench_routes(Routes& routes, const LabServices& lab) {
  routes.add("GET", "/api/bench",
             [&lab](const auto&, const auto&) { return json_answer(lab.bench.state()); });
  routes.add("GET", "/api/bench/picture.png", [&lab](const auto&, const auto&) {
    const std::string picture = lab.bench.picture();
    return WebResponse{.status = picture.empty() ? 204 : 200, .type = "image/png", .body = picture};
  });
  routes.add("POST", "/api/bench/*", [&lab](const auto& r, const auto& names) {
    return json_answer(control(lab, body_of(r), names[0]));
  });
}

}  // namespace faba
