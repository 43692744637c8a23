#include <fmt/format.h>

#include <CLI/CLI.hpp>

#include "app/bench/open_bench.h"
#include "cli/command_line.h"
#include "cli/options/bench.h"
#include "core/error.h"
#include "study/plot/markup.h"

namespace faba::cli {
namespace {

int rig_check(const SceneOptions& v, const Common& c) {
  constexpr double kLook = 2;  // s
  Scenario s = read_bench_scene(v);
  const Json j = check_bench(s, s.params.seed.value_or(1), kLook);
  const int code = j.at("cannot_arm").is_null() ? 0 : int(Errc::device);
  if (c.json) {
    fmt::print("{}\n", j.dump());
    return code;
  }
  const auto said = [&](const char* key, const char* unit) {
    return j.at(key).is_null() ? std::string("-") : three_digits(j.at(key).get<double>()) + unit;
  };
  fmt::print(
      "camera   {}: {} x {} px, {}, {} after mid-exposure, decided on after {}; {} frames, {} dropped, {} "
      "corrupt\n",
      j["camera"].get<std::string>(), j["size_px"][0].dump(), j["size_px"][1].dump(), said("rate_hz", " Hz"),
      said("age_ms", " ms"), said("delay_ms", " ms"), j["frames"].dump(), j["dropped"].dump(),
      j["corrupt"].dump());
  if (j["swarm"].is_null())
    fmt::print("swarm    none is seen\n");
  else
    fmt::print("swarm    some {} cells about ({}, {}) px\n", three_digits(j["swarm"]["cells"].get<double>()),
               three_digits(j["swarm"]["centroid_px"][0].get<double>()),
               three_digits(j["swarm"]["centroid_px"][1].get<double>()));
  std::string sensed;
  for (const Json& a : j["sensed_a"])
    sensed += " " + (a.is_null() ? "-" : fmt::format("{:.3f} A", a.get<double>()));
  fmt::print("coils    {}: {}; sensed{}\n", j["driver"].get<std::string>(), j["guard"].get<std::string>(),
             sensed);
  if (!j["cannot_arm"].is_null())
    fmt::print("         cannot be armed: {}\n", j["cannot_arm"].get<std::string>());
  return code;
}

}  // namespace

void add_rig_check(CLI::App& rig, CommandLine& line) {
  const auto o = std::make_shared<SceneOptions>();
  CLI::App* v =
      verb(rig, line, "check", "Look through the camera and ask the coils' driver, without any current",
           "  faba rig check scenes/bench.toml");
  add_bench_scene(v, *o);
  v->callback([o, &line] { line.code = rig_check(*o, line.common); });
}

}  // namespace faba::cli
