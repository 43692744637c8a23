#include "app/sinks/sinks.h"

#include <fmt/format.h>

#include <algorithm>

#include "app/run/simulation.h"
#include "app/sinks/drawn_swarm.h"
#include "vision/files/video_format.h"

namespace faba {
void check_recording(const Record& record, const Frame& frame, double rate) {
  if (!record.video && !record.lossless) return;
  if (std::max(frame.width, frame.height) > kMaxVideoSide)
    throw Error(
        Errc::usage, "arena",
        fmt::format("a video of {} x {} px is too large, the maximum is {} px; use a smaller view, or set "
                    "record.video = false",
                    frame.width, frame.height, kMaxVideoSide));
  const double fps = rate / record.video_every;
  if (fps < kMinFrameRate || fps > kMaxFrameRate)
    throw Error(Errc::usage, record.video_every > 1 ? "record.video_every" : "camera.rate",
                fmt::format("a video cannot have {:g} frames per second; change record.video_every, or set "
                            "record.video = false",
                            fps));
}

SinkContext sink_context(const Scenario& s, Simulation& simulation, Pool& pool,
                         const std::filesystem::path& dir) {
  SinkContext c = series_context(s, simulation, pool);
  const auto every = std::uint64_t(s.record.video_every);
  c.dir = dir;
  c.kept = std::make_shared<KeptFrames>((c.recorded.end - c.recorded.first + every - 1) / every);
  if (!s.record.as_seen) {
    const auto drawn = std::make_shared<DrawnSwarm>(simulation.world(), simulation.loop(), s.scale.um_per_px);
    c.draw = [drawn, rate = s.camera.rate](const Tick& t, RgbImage& picture) {
      drawn->draw(double(t.index) / rate, t.target.position, picture);
    };
  }
  return c;
}

}  // namespace faba
