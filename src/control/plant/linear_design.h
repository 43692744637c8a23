#pragma once
#include <complex>
#include <optional>
#include <vector>

#include "control/plant/motion_model.h"

namespace faba {

/// Weights of a linear-quadratic regulator by Bryson's rule: values that are worth the full command.
struct LqrWeights {
  double error = 0;                          ///< m
  std::optional<double> velocity = {};       ///< m/s; none: the velocity costs nothing
  std::optional<double> integral_time = {};  ///< s; the integral of `error` over this time; none: no integral
};

/// A linear-quadratic regulator of one axis, a = -(position e + velocity v + integral of e), and its loop
/// with a camera delay that a predictor compensates.
struct LqrDesign {
  LinearPlant plant;
  double period = 0;                        ///< s, between two commands
  double position = 0;                      ///< 1/m
  double velocity = 0;                      ///< s/m; 0 for an immediate plant
  double integral = 0;                      ///< 1/(m s)
  std::vector<std::complex<double>> poles;  ///< of the closed loop, per frame (z plane)
  double cost = 0;  ///< cost to go of a position error, 1/m^2, in units of a full command for one frame
  double cost_cross = 0, cost_velocity = 0;  ///< s/m^2 and s^2/m^2
};
/// Solves the discrete Riccati equation. `period` in s. All gains are zero for a plant that does not move.
LqrDesign lqr_design(const LinearPlant& plant, double period, const LqrWeights& weights);

/// Stability margins of the loop, broken at the command.
struct Margins {
  double gain = 0;   ///< smallest factor above 1 with which the loop becomes unstable; infinity: none
  double phase = 0;  ///< rad
  double delay = 0;  ///< s: the additional delay with which it becomes unstable
};
/// `delay`: periods between a picture and the command computed from it, which the controller predicts over
/// with the same plant.
Margins margins_of(const LqrDesign& design, int delay);

/// Advances position and velocity of the linear plant by one period: x(k+1) = a x(k) + b command(k).
struct DiscretePlant {
  double position_by_velocity = 0;  ///< s
  double velocity_by_velocity = 0;
  double position_by_command = 0;  ///< m
  double velocity_by_command = 0;  ///< m/s
};
DiscretePlant discrete(const LinearPlant& plant, double period);

}  // namespace faba
