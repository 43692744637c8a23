#include "app/sinks/sinks.h"

#include "app/simulation.h"

namespace faba {

SinkContext sink_context(const Scenario& s, Simulation& simulation, Pool& pool,
                         const std::filesystem::path& dir) {
  return {.dir = dir,
          .world = &simulation.world(),
          .loop = &simulation.loop(),
          .frame = simulation.frame(),
          .scale = s.si_scale(),
          .frame_rate = s.camera.rate,
          .record = s.record,
          .dose = s.motility.type != "none",
          .rig = &simulation.rig(),
          .jitter = s.camera.jitter > 0,
          .flow = s.flow,
          .pool = &pool};
}

}  // namespace faba
