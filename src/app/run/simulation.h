#pragma once
#include <memory>

#include "app/loop/loop.h"
#include "app/scenario/scenario.h"
#include "rig/simulated/sim_rig.h"

namespace faba {

/// Context for the construction of the estimator, reference and controller of a scenario.
ControlContext control_context(const Scenario& s, const std::shared_ptr<const Field>& field,
                               const Frame& frame, const std::shared_ptr<const FieldLibrary>& library);

/// The simulation of a scenario: all parts constructed and connected, nothing recorded. `faba run` records
/// it; tests, benchmarks and studies step it directly.
class Simulation {
 public:
  /// Throws Error(usage) if the parts are incompatible. `ground`: content of the video microscope.background,
  /// so that repeated simulations read it only once; null: it is read.
  Simulation(const Scenario& s, std::uint64_t seed, Pool& pool,
             const std::shared_ptr<const VideoBackground>& ground = nullptr);
  Simulation(const Simulation&) = delete;
  Simulation& operator=(const Simulation&) = delete;

  World& world() { return *world_; }
  const World& world() const { return *world_; }
  Loop& loop() { return *loop_; }
  SimRig& rig() { return *rig_; }
  const Reference& reference() const { return *reference_; }
  const Controller& controller() const { return *controller_; }
  /// Context in which the estimator, reference and controller were constructed.
  const ControlContext& control() const { return control_; }
  const Frame& frame() const { return frame_; }
  double step() const { return world_->parts().dt; }
  /// Hash of the state with the coils de-energised, as at the end of a run.
  std::string state_hash() const;
  /// The complete state of the simulation, for checkpoints.
  void archive(Archive& a);
  /// Exchanges the parts that the event names immediately; events of the scenario are applied automatically.
  /// On Error(usage) for unsuitable parts nothing has been changed.
  void apply(const Event& e);

 private:
  struct Exchanged;
  Exchanged make(const Event& e) const;
  void apply_due(std::uint64_t cycles);  ///< applies the events before this cycle

  Frame frame_;
  ControlContext control_;
  double strongest_t_ = 0;  ///< maximum field in the arena, T
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
