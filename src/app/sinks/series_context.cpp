#include "app/run/simulation.h"
#include "app/sinks/sinks.h"

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

SinkContext series_context(const Scenario& s, Simulation& simulation, Pool& pool) {
  const bool jitter = s.camera.jitter > 0;
  return {.dir = {},
          .frames = std::make_shared<SimulatedFrames>(simulation.rig(), jitter, s.camera.rate),
          .field = simulation.world().parts().field,
          .frame = simulation.frame(),
          .scale = s.si_scale(),
          .um_per_px = s.scale.um_per_px,
          .frame_rate = s.camera.rate,
          .record = s.record,
          .recorded = s.recorded_frames(),
          .dose = !s.motility.has(Trait::inert),
          .jitter = jitter,
          .flow = s.flow,
          .pool = &pool,
          .truth = &simulation.world()};
}

}  // namespace faba
