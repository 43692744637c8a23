#pragma once
#include <vector>

#include "app/scenario/scenario.h"
#include "rig/guard/guard_link.h"

namespace faba {

/// Coil currents that a user sets by hand: within permitted_currents(), and approached at the slew rate of
/// the guard. The coils start disarmed, and all currents are zero while they are.
class CoilJog {
 public:
  static constexpr double kCycle = 0.02;  ///< s, between two calls of step()

  /// `s`: with [rig].
  CoilJog(GuardLink& coils, const Scenario& s);

  std::size_t coils() const { return limits_.size(); }
  double limit(std::size_t coil) const { return limits_[coil]; }         ///< A
  double requested(std::size_t coil) const { return requested_[coil]; }  ///< A
  const std::vector<double>& requested() const { return requested_; }
  /// A current outside the limits is replaced by the limit, one that is not a number by zero.
  void request(std::size_t coil, double current);
  void all_zero();
  /// Throws Error(device) with the guard's reason if it refuses.
  void arm();
  /// Resets a fault; the coils are then disarmed.
  void reset();
  void disarm() noexcept { coils_.disarm(); }
  /// Sends the currents of this cycle; returns the newest report of the guard.
  GuardReport step();

 private:
  GuardLink& coils_;
  std::vector<double> limits_, requested_;
  std::vector<double> current_;  ///< sent to the guard, limited in slew rate
  double max_change_per_s_;      ///< A/s
  double last_;                  ///< s, time of the previous step
};

}  // namespace faba
