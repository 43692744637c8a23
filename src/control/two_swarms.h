#pragma once
#include <array>
#include <cmath>
#include <optional>

#include "control/controller.h"

namespace faba {

/// A controller that steers two swarms, for which the estimator must give several groups.
class TwoSwarmController : public Controller {
 public:
  /// Distances of the first and the second swarm from their setpoints at the last update, m, as it follows
  /// them; NaN before the first update and without a setpoint.
  virtual std::array<double, 2> distances() const = 0;
  /// Given setpoint of the second swarm, world frame, m; empty: it is held where it is.
  virtual std::optional<Vec2> second_setpoint() const = 0;
  /// Whether it expects swarms of opposite polarity.
  virtual bool opposite() const = 0;
};

/// The same in px; empty for a controller of one swarm, and where a distance is not known.
inline std::optional<std::array<double, 2>> two_swarm_distances_px(const Controller& c, double m_per_px) {
  const auto* two = dynamic_cast<const TwoSwarmController*>(&c);
  if (two == nullptr) return std::nullopt;
  const auto [first, second] = two->distances();
  if (!std::isfinite(first) || !std::isfinite(second)) return std::nullopt;
  return {{first / m_per_px, second / m_per_px}};
}

}  // namespace faba
