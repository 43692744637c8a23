#pragma once
#include <cstddef>

#include "control/controller.h"

namespace faba {

/// Number of setpoints of a reference; one that is repeated immediately counts once, as in series.csv.
inline std::size_t setpoint_count(const Reference& reference) {
  const std::vector<Vec2> all = reference.setpoints();
  std::size_t count = 0;
  for (std::size_t i = 0; i < all.size(); ++i) count += i == 0 || !(all[i] == all[i - 1]);
  return count;
}

}  // namespace faba
