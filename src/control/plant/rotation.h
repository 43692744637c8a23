#pragma once
#include <optional>

#include "control/controller.h"
#include "core/schema.h"

namespace faba {

/// Parameters of a rotating field.
struct RotationParams {
  std::optional<double> rotating = {}, frequency = {};
  double gain = 0.45;
  static Schema<RotationParams> schema();
};

/// A field that rotates at constant rate (theory B3.6), set once per frame. The held field is, to the first
/// harmonic, a rotating field of B_rot sin(x) / x that is late by half a frame, with x half the angle per
/// frame.
class Rotation {
 public:
  /// Largest constant bias, relative to the rotating field: up to it the drift is linear in the bias.
  static constexpr double kLargestBias = 0.3;

  /// `strength`: default magnitude, T; less if the coils cannot make it with the bias. Throws Error(usage)
  /// when the cells, the coils or the camera cannot follow the rotation.
  Rotation(const RotationParams& p, double strength, const SwarmMotion& motion, const ControlContext& c);

  double strength() const { return strength_; }    ///< T
  double effective() const { return effective_; }  ///< T, of the first harmonic
  double rate() const { return rate_; }            ///< rad/s, counter-clockwise positive
  /// Turns the field by the time since the last command, s.
  void advance(double dt);
  /// The field times the polarity for the next frame, T.
  Vec2 field() const;
  /// Unit vector along the first harmonic of the field, `age` s before the next frame.
  Vec2 direction(double age) const;
  void archive(Archive& a) { a& phase_; }

 private:
  double strength_ = 0, effective_ = 0, rate_ = 0, period_ = 0;
  double phase_ = 0;  ///< rad, of the field in the next frame
};

/// A swarm that circles in a rotating field. Its headings lag the field by phi* = arcsin(rate / w_B); its
/// guiding centre drifts by a constant bias B_dc (theory B3.8),
///   drift = efficiency speed B_dc / B_rot, turned by phi* in the sense of the rotation.
class CirclingSwarm {
 public:
  CirclingSwarm(const SwarmMotion& motion, const Rotation& r, double gain, const ControlContext& c);

  /// m/s; the largest with which the guiding centre can be moved.
  double max_drift() const { return Rotation::kLargestBias * efficiency_ * speed_; }
  double speed() const { return speed_; }                   ///< m/s, along the circle
  double mobility() const { return efficiency_ * speed_; }  ///< drift per relative bias, m/s
  /// The centre of the circle of a swarm at `position`, m, `age` s before the next frame. `sign`: -1 for a
  /// swarm that swims against the field times the polarity of the rotation, else 1.
  Vec2 centre(Vec2 position, double age, double sign, const Rotation& r) const;
  double gain() const { return gain_; }  ///< 1/s; of the drift per error
  /// Drift towards an error, m: proportional, limited to max_drift().
  Vec2 drift(Vec2 error) const;
  /// The field times the polarity, T, that holds a swarm at `position`, m, and moves it to `target`: the
  /// rotating field and the bias. A target that is not finite: the rotating field only. `age`: as for
  /// centre().
  Vec2 hold(Vec2 position, Vec2 target, double age, const Rotation& r) const;
  /// The constant field times the polarity for a drift, T.
  Vec2 bias(Vec2 drift, const Rotation& r) const;
  /// The drift by a constant field, T: the inverse of bias().
  Vec2 drift_by(Vec2 bias, const Rotation& r) const;

 private:
  double speed_, efficiency_;
  double sine_, cosine_;  ///< of phi*, with the sign of the rotation
  double gain_;           ///< 1/s
};

}  // namespace faba
