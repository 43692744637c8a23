#pragma once
#include <memory>

#include "app/loop/loop.h"
#include "app/scenario/scenario.h"
#include "rig/simulated/sim_rig.h"

namespace faba {

/// What the estimator, reference and controller of a scenario are made with.
ControlContext control_context(const Scenario& s, const std::shared_ptr<const Field>& field,
                               const Frame& frame, const std::shared_ptr<const FieldLibrary>& library);

/// A scenario brought to life: every part built and connected, nothing recorded. What `faba run` records, and
/// what tests, benchmarks and studies step directly.
class Simulation {
 public:
  /// Throws Error(usage) when the parts do not fit together. `ground`, when given, is what a video shows that
  /// microscope.background names: those who simulate many times read it once; else it is read.
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
  /// Exchanges the parts that the event names, now. Those of the scenario do so by themselves. Throws
  /// Error(usage), having changed nothing, for parts that do not fit.
  void apply(const Event& e);

 private:
  struct Exchanged;
  Exchanged make(const Event& e) const;
  void apply_due(std::uint64_t turns);  ///< the events before the turn of that number

  Frame frame_;
  ControlContext control_;
  double strongest_t_ = 0;  ///< the largest field in the arena, T
  std::vector<Event> events_;
  std::size_t next_event_ = 0;
  std::unique_ptr<World> world_;
  std::unique_ptr<SimRig> rig_;
  std::unique_ptr<Estimator> estimator_;
  std::unique_ptr<Reference> reference_;
  std::unique_ptr<Controller> controller_;
  Limits limits_{Limits::Params{}};
  std::unique_ptr<Loop> loop_;
};

}  // namespace faba
