#pragma once
#include <memory>
#include <string>
#include <vector>

#include "study/steering/controller_study.h"

namespace faba {

/// A combination of controller, model and delay, with its scenario.
struct Setting {
  std::size_t controller = 0, model = 0;
  int delay = 0;
  Scenario scenario;
  std::size_t setpoints = 0;  ///< of the reference
};
using Settings = std::shared_ptr<const std::vector<Setting>>;

/// All settings of a study, by model, delay and controller; adds notes on doubtful scenarios to `notes`.
/// Throws Error(usage) for invalid combinations.
Settings settings_of(const ControllerStudy& study, std::vector<std::string>* notes = nullptr);
/// The round of all trials: for each setting, one trial for each seed.
Round trials_of(const ControllerStudy& study, const Settings& all, const std::function<bool()>& stop);

}  // namespace faba
