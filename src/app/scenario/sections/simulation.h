#pragma once
#include <limits>
#include <optional>

#include "core/schema.h"

namespace faba {

/// The table [simulation].
struct SimulationParams {
  std::optional<double> step;
  double longest =
      std::numeric_limits<double>::infinity();  ///< maximum of the default step, s; not a scenario key
  static Schema<SimulationParams> schema();
};

}  // namespace faba
