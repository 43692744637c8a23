#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <cstdio>

#include "app/bench/simulated_bench.h"
#include "app/run/random_seed.h"
#include "cli/command_line.h"
#include "cli/options/bench.h"
#include "core/error.h"
#include "study/plot/markup.h"

namespace faba::cli {
namespace {

struct SimulateVerb {
  SceneOptions run;
  std::filesystem::path at, log;
  bool once = false;
};

int rig_simulate(const SimulateVerb& v, const Common& c) {
  const Scenario s = read_bench_scene(v.run);
  const std::uint64_t seed = s.params.seed.value_or(random_seed());
  std::error_code ec;
  if (!v.run.force && std::filesystem::exists(v.log, ec))
    throw Error(Errc::usage, v.log.string(),
                "already exists; choose another --log, or --force to replace it");
  Pool pool(v.run.threads);
  const auto ready = [&] {
    if (c.quiet || c.json) return;
    fmt::print("simulated bench at {}; press Ctrl-C to stop it\n", v.at.string());
    std::fflush(stdout);
  };
  const SimulatedBench::Summary done = SimulatedBench::run(
      s, seed, pool, {.at = v.at, .log = v.log, .once = v.once, .stop = &stop_requested(), .ready = ready});
  if (c.json)
    fmt::print(
        "{}\n",
        Json{{"frames", done.frames}, {"unfetched", done.unfetched}, {"behind_s", done.behind}}.dump());
  else if (!c.quiet)
    fmt::print("{} frames, {} not fetched in time by a client; maximum delay behind the clock {} ms\n",
               done.frames, done.unfetched, three_digits(1e3 * done.behind));
  return 0;
}

}  // namespace

void add_rig_simulate(CLI::App& rig, CommandLine& line) {
  const auto o = std::make_shared<SimulateVerb>();
  CLI::App* v =
      verb(rig, line, "simulate", "Simulate a bench for other processes: microscope and coils in real time",
           "  faba rig simulate scenes/bench.toml --at /tmp/bench --log coils.csv");
  add_bench_scene(v, o->run);
  v->add_option("--at", o->at, "Path of the socket to create")
      ->required()
      ->check(not_empty)
      ->type_name("SOCKET");
  v->add_option("--log", o->log, "Write times, voltages and currents, as CSV")->check(not_empty);
  v->add_flag("--force", o->run.force, "Replace an existing log");
  v->add_flag("--once", o->once, "Stop when all clients have disconnected");
  v->callback([o, &line] { line.code = rig_simulate(*o, line.common); });
}

}  // namespace faba::cli
