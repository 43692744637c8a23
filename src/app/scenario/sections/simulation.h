#pragma once
#include <limits>
#include <optional>

#include "core/schema.h"

namespace faba {

/// The table [simulation].
struct SimulationParams {
  std::optional<double> step;
  double longest =
      std::numeric_limits<double>::infinity();  ///< s, of a step that is chosen; no key of a scenario
  static Schema<SimulationParams> schema();
};

}  // namespace faba
