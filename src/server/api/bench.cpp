#include <fmt/format.h>

#include <atomic>

#include "app/scenario/read_scenario.h"
#include "app/scenario/scenario.h"
#include "core/error.h"
#include "core/file.h"
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
  const std::string now = lab.bench.picture();
  if (now.empty()) throw Error(Errc::input, "bench", "no image from the camera");
  const fs::path taken = lab.pictures / fmt::format("ruler-taken-{}.png", ++number);
  write_file(taken, now);
  return measure_ruler(lab, taken, asked.value("tick_um", 0.0), "calibrations/" + objective, ".png");
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
    return measure_objective(lab, asked);
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
