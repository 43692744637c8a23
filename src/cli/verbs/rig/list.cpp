#include <fmt/format.h>

#include <CLI/CLI.hpp>

#include "app/bench/open_bench.h"
#include "cli/command_line.h"

namespace faba::cli {
namespace {

int rig_list(const Common& c) {
  const std::vector<Device> all = device_list();
  if (c.json) {
    Json j = Json::array();
    for (const Device& d : all) j.push_back({{"kind", d.kind}, {"name", d.name}, {"what", d.what}});
    fmt::print("{}\n", Json{{"devices", j}}.dump());
    return 0;
  }
  for (const Device& d : all) fmt::print("{:<14}  {:<24}  {}\n", d.kind, d.name, d.what);
  if (c.quiet) return 0;
  if (all.empty()) fmt::print("no camera, serial port or current output device (NI-DAQmx) found\n");
  fmt::print(
      "coils: a serial board is recommended (driver \"serial\"), because it switches off by itself; NI-DAQmx "
      "for Linux "
      "does not support USB-6008 and USB-6009, NI-DAQmx Base does\n"
      "always available: camera \"simulated\" and \"playback\", driver \"simulated\" and \"none\"; see faba "
      "parts camera, faba parts driver\n");
  return 0;
}

}  // namespace

void add_rig_list(CLI::App& rig, CommandLine& line) {
  CLI::App* v =
      verb(rig, line, "list", "List the cameras and coil drivers of this machine", "  faba rig list");
  v->callback([&line] { line.code = rig_list(line.common); });
}

}  // namespace faba::cli
