#include <fmt/format.h>

#include <CLI/CLI.hpp>

#include "app/bench/replay.h"
#include "cli/command_line.h"
#include "cli/progress.h"
#include "core/error.h"
#include "core/toml.h"

namespace faba::cli {
namespace {

int rig_replay(const std::string& dir, const Common& c) {
  Progress bar("replaying", !c.quiet && !c.json);
  const Replayed r = replay_run(dir, builtin_parts(), [&](std::uint64_t done, std::uint64_t total) {
    bar.update(done, total);
    return !stop_requested().load();
  });
  bar.clear();
  const bool same = r.equal == r.recorded;
  if (c.json)
    fmt::print("{}\n", Json{{"recorded", r.recorded},
                            {"equal_commands", r.equal},
                            {"same", same},
                            {"first_difference", r.first_difference ? Json(*r.first_difference) : Json()}}
                           .dump());
  else if (!c.quiet)
    fmt::print(
        "{} of {} commands are bit-identical{}\n", r.equal, r.recorded,
        r.first_difference ? fmt::format("; the first difference is at frame {}", *r.first_difference) : "");
  return same ? 0 : int(Errc::internal);
}

}  // namespace

void add_rig_replay(CLI::App& rig, CommandLine& line) {
  const auto o = std::make_shared<std::string>();
  CLI::App* v =
      verb(rig, line, "replay", "Compute the commands of a recorded run again and compare them bit by bit",
           "  faba rig replay runs/bench-bench");
  v->add_option("dir", *o, "Run directory with video.avi")->required();
  v->callback([o, &line] { line.code = rig_replay(*o, line.common); });
}

}  // namespace faba::cli
