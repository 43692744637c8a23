#include "app/sinks/sinks.h"

#include <fmt/format.h>

#include <algorithm>

#include "app/run/simulation.h"
#include "vision/files/video_format.h"

namespace faba {

void check_recording(const Record& record, const Frame& frame, double rate) {
  if (!record.video && !record.lossless) return;
  if (std::max(frame.width, frame.height) > kLongestVideoSide)
    throw Error(Errc::usage, "arena",
                fmt::format("a video of {} x {} px is not possible, {} px is the most; a smaller view, or "
                            "record.video = false",
                            frame.width, frame.height, kLongestVideoSide));
  const double fps = rate / record.video_every;
  if (fps < kSlowestVideo || fps > kFastestVideo)
    throw Error(Errc::usage, "camera.rate",
                fmt::format("a video cannot have {:g} frames per second; another record.video_every, or "
                            "record.video = false",
                            fps));
}

SinkContext sink_context(const Scenario& s, Simulation& simulation, Pool& pool,
                         const std::filesystem::path& dir) {
  return {.dir = dir,
          .world = &simulation.world(),
          .field = simulation.world().parts().field,
          .loop = &simulation.loop(),
          .frame = simulation.frame(),
          .scale = s.si_scale(),
          .frame_rate = s.camera.rate,
          .record = s.record,
          .dose = !s.motility.has(Trait::inert),
          .rig = &simulation.rig(),
          .jitter = s.camera.jitter > 0,
          .flow = s.flow,
          .pool = &pool};
}

}  // namespace faba
