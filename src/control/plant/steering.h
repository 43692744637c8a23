#pragma once
#include <vector>

#include "control/duty.h"
#include "control/plant/motion_model.h"

namespace faba {

/// What the controllers that are designed from the plant have in common: where the swarm is when their
/// command acts, and the currents for a command of |a| <= 1.
class Steering {
 public:
  /// `max_output`: field of a full command, in field units.
  Steering(const MotionParams& motion, double max_output, const ControlContext& c);

  /// Of a swarm whose drift has one speed: that of the mean over modulated commands.
  const SwarmMotion& plant() const { return plant_; }
  double strongest() const { return strongest_; }  ///< T, of a full command
  double max_field() const;                        ///< T, with the compensation of the ambient field
  /// Position, m, and velocity, m/s, of the swarm at the time at which the next command acts: those of an
  /// estimator that predicts, otherwise predicted by the plant from the commands since the picture.
  MeanState at_command(const Estimate& e) const;
  /// The currents for a command at a position, m, without the modulation; linear in `a`.
  Command linear(Vec2 at, Vec2 a) const;
  /// The currents that make the swarm swim along `a`; the ambient field is compensated.
  Command command(const Estimate& e, Vec2 a);
  /// No currents; for an estimate without cells.
  Command none();
  void archive(Archive& a) { a& given_& duty_; }

 private:
  ControlContext c_;
  double strongest_;
  SwarmMotion plant_;
  bool modulated_ = false;   ///< the speed does not depend on the field: the mean drift of full commands does
  std::size_t delay_;        ///< frames
  std::vector<Vec2> given_;  ///< fields of the last commands, T, the oldest first
  Duty duty_;
};

}  // namespace faba
