#include <fmt/format.h>

#include <CLI/CLI.hpp>

#include "app/bench/open_bench.h"
#include "cli/command_line.h"
#include "cli/options/bench.h"
#include "core/error.h"
#include "study/plot/markup.h"

namespace faba::cli {
namespace {

Json check_json(const BenchCheck& b) {
  Json sensed = Json::array();
  for (const double a : b.sensed_a) sensed.push_back(std::isnan(a) ? Json() : Json(a));
  Json j = {{"camera", b.camera},
            {"size_px", {b.width_px, b.height_px}},
            {"rate_hz", b.rate_hz ? Json(*b.rate_hz) : Json()},
            {"frames", b.frames},
            {"dropped", b.dropped},
            {"corrupt", b.corrupt},
            {"age_ms", 1e3 * b.age_s},
            {"delay_ms", 1e3 * b.delay_s},
            {"driver", b.driver},
            {"guard", b.guard},
            {"cannot_arm", b.cannot_arm.empty() ? Json() : Json(b.cannot_arm)},
            {"sensed_a", sensed},
            {"swarm", nullptr}};
  if (b.swarm)
    j["swarm"] = {{"cells", b.swarm->cells},
                  {"centroid_px", {b.swarm->centroid_px.x, b.swarm->centroid_px.y}}};
  return j;
}

void print_check(const BenchCheck& b) {
  fmt::print(
      "camera   {}: {} x {} px, {}; the last frame arrived {} after mid-exposure; the command is ready {} "
      "after mid-exposure (median); {} frames, {} dropped, {} corrupt\n",
      b.camera, b.width_px, b.height_px, b.rate_hz ? three_digits(*b.rate_hz) + " Hz" : "-",
      three_digits(1e3 * b.age_s) + " ms", three_digits(1e3 * b.delay_s) + " ms", b.frames, b.dropped,
      b.corrupt);
  if (b.swarm)
    fmt::print("swarm    about {} cells, centroid ({}, {}) px\n", three_digits(b.swarm->cells),
               three_digits(b.swarm->centroid_px.x), three_digits(b.swarm->centroid_px.y));
  else
    fmt::print("swarm    not detected\n");
  std::string sensed;
  for (const double a : b.sensed_a) sensed += " " + (std::isnan(a) ? "-" : fmt::format("{:.3f} A", a));
  fmt::print("coils    {}: {}; sensed{}\n", b.driver, b.guard, sensed);
  if (!b.cannot_arm.empty()) fmt::print("         cannot be armed: {}\n", b.cannot_arm);
}

int rig_check(const SceneOptions& v, const Common& c) {
  constexpr double kCheckTime = 2;  // s
  Scenario s = read_bench_scene(v);
  const BenchCheck check = check_bench(s, s.params.seed.value_or(1), kCheckTime);
  if (c.json)
    fmt::print("{}\n", check_json(check).dump());
  else
    print_check(check);
  return check.cannot_arm.empty() ? 0 : int(Errc::device);
}

}  // namespace

void add_rig_check(CLI::App& rig, CommandLine& line) {
  const auto o = std::make_shared<SceneOptions>();
  CLI::App* v = verb(rig, line, "check", "Check the camera and the coil driver, without current",
                     "  faba rig check scenes/bench.toml");
  add_bench_scene(v, *o);
  v->callback([o, &line] { line.code = rig_check(*o, line.common); });
}

}  // namespace faba::cli
