#pragma once
#include <array>
#include <string>
#include <vector>

#include "study/optics/optics_plan.h"
#include "study/quality/quality.h"

namespace faba {

/// Measurements whose validity follows from the optics.
enum class PlannedMeasurement {
  flow,      ///< optical flow with a direction
  tracking,  ///< tracks of single cells
  response,  ///< speed and fraction of the cells that respond to a field reversal (`faba activity`)
  edge,      ///< circle of the edge of the drop
  swarm      ///< formation of a swarm at the edge of the drop, in view
};
inline constexpr std::array kPlannedMeasurements{PlannedMeasurement::flow, PlannedMeasurement::tracking,
                                                 PlannedMeasurement::response, PlannedMeasurement::edge,
                                                 PlannedMeasurement::swarm};
const char* word_of(PlannedMeasurement measurement);
/// Title for people: "Optical flow" of flow.
const char* title_of(PlannedMeasurement measurement);

/// Whether a measurement will be valid. The limits are those of the warnings that the measurement itself
/// gives.
struct OpticsVerdict {
  PlannedMeasurement measurement = PlannedMeasurement::flow;
  std::string evidence = {};           ///< the figures that decide it, also if it is good
  std::vector<Warning> warnings = {};  ///< the violated assumptions

  Quality quality() const { return quality_of(warnings); }
};

/// The verdict of each measurement, in the order of kPlannedMeasurements.
std::vector<OpticsVerdict> optics_verdicts(const OpticsSetup& setup, const OpticsPlan& plan);

}  // namespace faba
