#include "app/sinks/sinks.h"

#include <fmt/format.h>

#include <algorithm>

#include "app/run/simulation.h"
#include "app/sinks/drawn_swarm.h"
#include "vision/files/video_format.h"

namespace faba {
namespace {

/// The camera of a simulation.
class SimulatedFrames final : public FrameSource {
 public:
  SimulatedFrames(SimRig& rig, bool jitter, double rate) : rig_(rig), jitter_(jitter), rate_(rate) {}
  double time_of(const Tick& t) const override { return at(t.index); }
  std::optional<double> planned_time(std::uint64_t cycle) const override { return rig_.time_of(cycle); }
  ImageRef picture(const Tick&) const override { return rig_.picture(); }
  int bits() const override { return rig_.bits(); }
  const Image<std::uint16_t>& deep_picture() const override { return rig_.deep_picture(); }

 private:
  double at(std::uint64_t cycle) const { return jitter_ ? rig_.time_of(cycle) : double(cycle) / rate_; }
  SimRig& rig_;
  bool jitter_;
  double rate_;  ///< Hz
};

}  // namespace

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
  const bool jitter = s.camera.jitter > 0;
  const auto every = std::uint64_t(s.record.video_every);
  const FrameRange part = s.recorded_frames();
  const std::uint64_t frames = (part.end - part.first + every - 1) / every;
  SinkContext c{.dir = dir,
                .frames = std::make_shared<SimulatedFrames>(simulation.rig(), jitter, s.camera.rate),
                .field = simulation.world().parts().field,
                .frame = simulation.frame(),
                .scale = s.si_scale(),
                .um_per_px = s.scale.um_per_px,
                .frame_rate = s.camera.rate,
                .record = s.record,
                .recorded = part,
                .dose = !s.motility.has(Trait::inert),
                .jitter = jitter,
                .flow = s.flow,
                .pool = &pool,
                .truth = &simulation.world(),
                .kept = std::make_shared<KeptFrames>(frames)};
  if (!s.record.as_seen) {
    const auto drawn = std::make_shared<DrawnSwarm>(simulation.world(), simulation.loop(), s.scale.um_per_px);
    c.draw = [drawn, rate = s.camera.rate](const Tick& t) {
      return drawn->draw(double(t.index) / rate, t.target.position);
    };
  }
  return c;
}

}  // namespace faba
