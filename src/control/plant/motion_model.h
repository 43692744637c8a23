#pragma once
#include <optional>

#include "control/controller.h"
#include "core/schema.h"
#include "core/swarm_motion.h"

namespace faba {

/// Parameters of the plant in estimators and controllers; what is not set is that of the first swarm's model.
struct MotionParams {
  std::optional<double> speed, turning, rotational_diffusion, mobility;
  static Schema<MotionParams> schema();
  /// `model` with the values that are set.
  SwarmMotion of(const SwarmMotion& model) const;
};

/// Mean of a swarm: position, m, and velocity relative to the medium, m/s; world frame.
struct MeanState {
  Vec2 position, velocity;
};

/// Advances the mean of a swarm by `time` (s) in a field `along`, T: the field times the polarity, so that
/// cells swim along it. `factor`: speed relative to that of the plant. Turning swarms: the first moment of
/// the Fokker-Planck equation of the heading,
///   dv/dt = speed turning ((1 - R^4)/2 B_parallel + (1 + R^4)/2 B_normal) - diffusion v,  R = |v| / speed,
/// closed by the wrapped normal distribution (theory F2). B_parallel is the component of the field along v.
MeanState advanced(const SwarmMotion& m, double factor, MeanState s, Vec2 along, double time);

/// The plant about rest, for one axis: dv/dt = gain a - rate v with the command |a| <= 1, or v = gain a at
/// once.
struct LinearPlant {
  bool immediate = false;
  double gain = 0;  ///< m/s^2, or m/s if immediate
  double rate = 0;  ///< 1/s
};
/// `strongest`: field for |a| = 1, T.
LinearPlant linear_plant(const SwarmMotion& m, double strongest);

/// The field times the polarity at a position, T.
Vec2 field_along(const ControlContext& c, Vec2 at, const Command& command);

}  // namespace faba
