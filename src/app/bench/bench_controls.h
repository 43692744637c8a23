#pragma once
#include <memory>

#include "app/loop/loop.h"
#include "app/scenario/scenario.h"

namespace faba {

/// What closes the loop of a scenario on a bench, where nothing is simulated: eyes and hands are somebody
/// else's.
struct BenchControls {
  /// Throws Error(usage) for a scenario without [rig], or one whose parts do not fit together.
  explicit BenchControls(const Scenario& s);

  std::shared_ptr<const Field> field;
  Frame frame;
  std::unique_ptr<Estimator> estimator;
  std::unique_ptr<Reference> reference;
  std::unique_ptr<Controller> controller;
  Limits limits;  ///< of the scenario and of the coils as they are wired

  Loop loop(Rig& rig, double frame_period);
};

}  // namespace faba
