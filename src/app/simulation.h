#pragma once
#include <memory>

#include "app/scenario.h"
#include "rig/sim_rig.h"

namespace faba {

/// A scenario brought to life: every part built and connected, nothing recorded. What `faba run` records, and
/// what tests, benchmarks and studies step directly.
class Simulation {
 public:
  /// Throws Error(usage) when the parts do not fit together. `ground`, when given, is what a video shows that
  /// microscope.background names: those who simulate many times read it once.
  Simulation(const Scenario& s, std::uint64_t seed, Pool& pool,
             const std::shared_ptr<const VideoGround>& ground = nullptr);
  Simulation(const Simulation&) = delete;
  Simulation& operator=(const Simulation&) = delete;

  World& world() { return *world_; }
  const World& world() const { return *world_; }
  Loop& loop() { return *loop_; }
  SimRig& rig() { return *rig_; }
  const Reference& reference() const { return *reference_; }
  const Frame& frame() const { return frame_; }
  double step() const { return world_->parts().dt; }
  /// Everything that changes while it runs, for checkpoints.
  void archive(Archive& a);

 private:
  Frame frame_;
  std::unique_ptr<World> world_;
  std::unique_ptr<SimRig> rig_;
  std::unique_ptr<Estimator> estimator_;
  std::unique_ptr<Reference> reference_;
  std::unique_ptr<Controller> controller_;
  Limits limits_{Limits::Params{}};
  std::unique_ptr<Loop> loop_;
};

}  // namespace faba
