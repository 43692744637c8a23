#include "app/bench/replay.h"
#include "app/scenario/read_scenario.h"

#include <fmt/format.h>

#include <limits>

#include "app/bench/bench_controls.h"
#include "app/recording/run_directory.h"
#include "rig/bench/replay_rig.h"

namespace faba {

Replayed replay_run(const std::filesystem::path& dir, const Parts& parts,
                    const std::function<bool(std::uint64_t done, std::uint64_t total)>& keep_running) {
  std::error_code ec;
  const auto commands = dir / run_files::kCommands, video = dir / "video.avi";
  if (!std::filesystem::exists(dir, ec))
    throw Error(Errc::input, dir.string(), "directory not found; give a run directory, such as runs/steer-1");
  if (!std::filesystem::is_directory(dir, ec))
    throw Error(Errc::input, dir.string(), "is a file; specify a run directory");
  if (!std::filesystem::exists(commands, ec))
    throw Error(Errc::input, dir.string(), "is not a run on a bench: commands.csv not found");
  if (!std::filesystem::exists(video, ec))
    throw Error(Errc::input, dir.string(), "video.avi not found; record the run with record.lossless = true");
  const Scenario s = read_scenario(read_toml(dir / run_files::kScenario), parts);
  BenchControls controls(s);
  ReplayRig rig(video, commands);
  Loop loop = controls.loop(rig, s.frame_period());
  bool stopped = false;
  run(loop, std::numeric_limits<std::uint64_t>::max(), [&] {
    stopped = !keep_running(loop.next, rig.frames());
    return !stopped;
  });
  if (stopped) throw Error(Errc::interrupted, dir.string(), "replay interrupted");
  if (loop.next < rig.frames())
    throw Error(Errc::input, video.string(),
                fmt::format("has {} frames, but commands.csv has {}", loop.next, rig.frames()));
  if (rig.more())
    throw Error(Errc::input, commands.string(),
                fmt::format("has {} frames, but video.avi has more", rig.frames()));
  return {rig.frames(), rig.equal(), rig.first_difference()};
}

}  // namespace faba
