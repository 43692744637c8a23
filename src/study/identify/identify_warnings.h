#pragma once
#include <string>
#include <vector>

#include "study/identify/identification.h"
#include "study/quality/quality.h"

namespace faba {

/// A statistic of the videos beside its prediction by a model at the posterior median.
struct StatisticCheck {
  std::string name;
  double observed = 0, predicted = 0, sd = 0;
  double deviation() const { return (observed - predicted) / sd; }  ///< in standard deviations of simulations
  bool fits() const;
};
/// The checks of all statistics; empty for a failed model.
std::vector<StatisticCheck> checks_of(const Identification& result, const FoundModel& model);

/// The violated assumptions of an identification: no model fits and which statistics it misses, times or
/// field strengths that were not given, and parameters that the videos do not determine.
std::vector<Warning> identify_warnings(const Identification& result);

}  // namespace faba
