#pragma once
#include <memory>

#include "app/loop/loop.h"
#include "app/scenario/scenario.h"

namespace faba {

/// Maximum current of each coil of a bench, A: permitted by the limits of the scenario and of the wired coil.
/// Throws Error(usage) for a scenario without [rig].
std::vector<double> permitted_currents(const Scenario& s);

/// The parts of the control loop of a scenario on a bench: estimator, reference, controller and limits,
/// without a simulation.
struct BenchControls {
  /// Throws Error(usage) for a scenario without [rig], or with incompatible parts.
  explicit BenchControls(const Scenario& s);

  std::shared_ptr<const Field> field;
  Frame frame;
  std::unique_ptr<Estimator> estimator;
  std::unique_ptr<Reference> reference;
  std::unique_ptr<Controller> controller;
  Limits limits;  ///< of the scenario and of the wired coils

  Loop loop(Rig& rig, double frame_period);
};

}  // namespace faba
