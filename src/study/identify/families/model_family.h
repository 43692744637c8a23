#pragma once
#include <array>
#include <functional>
#include <string>
#include <vector>

#include "study/identify/identify_study.h"

namespace faba {

/// A property of the cells or of the experiment that a candidate does not have: cells that tumble, a second
/// population, a drift of the stage. It is simulated in an amount that changes the statistics clearly; the
/// change is assumed to be proportional to the amount.
struct ModelFamily {
  std::string aspect;       ///< of a warning: "turning"
  std::string what;         ///< "the cells tumble"
  std::string unit;         ///< of the amount, "per s"
  double amount = 0;        ///< that is simulated
  bool two_sided = false;   ///< the amount can be negative
  bool of_cells = true;     ///< a property of the cells, which may differ between models
  std::string advice = {};  ///< what to do, with the line for the study
  /// How a simulation with it differs: changes of the scenario, of the field strength, and of the times of
  /// field reversals.
  std::function<void(Document&)> edit = {};
  double field_factor = 1, delay_frames = 0;
  /// Speed of all cells in the direction of the first field segment, px/s: not simulated, see
  /// EpisodeStatistics::of_drift(). 0: none.
  double drift_px_s = 0;
};

/// Aspects of all families.
inline constexpr std::array kFamilyAspects = {
    "turning",  "motile_fraction", "speed_spread", "populations", "responsive_fraction",
    "polarity", "field_strength",  "timing",       "drift"};

/// Divides the cells of the first swarm of a scenario: `fraction` of them become a second swarm.
void divide_swarm(Document& scenario, double fraction);

/// The families by which a candidate can be extended. `scenario`: of the candidate, with its free parameters.
std::vector<ModelFamily> families_of(const Candidate& candidate, const Json& scenario);

}  // namespace faba
