#include "app/bench/coil_jog.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "app/bench/bench_controls.h"
#include "core/monotonic.h"

namespace faba {

CoilJog::CoilJog(GuardLink& coils, const Scenario& s)
    : coils_(coils),
      limits_(permitted_currents(s)),
      requested_(limits_.size(), 0.0),
      current_(limits_.size(), 0.0),
      max_change_per_s_(s.rig->guard.max_slew.value_or(std::numeric_limits<double>::infinity())),
      last_(monotonic_now()) {}

void CoilJog::request(std::size_t coil, double current) {
  requested_[coil] = std::isnan(current) ? 0 : std::clamp(current, -limits_[coil], limits_[coil]);
}

void CoilJog::all_zero() { std::fill(requested_.begin(), requested_.end(), 0.0); }

void CoilJog::arm() { coils_.arm(); }

void CoilJog::reset() { coils_.reset(); }

GuardReport CoilJog::step() {
  if (coils_.report().state != CoilGuard::State::armed) {
    all_zero();  // there is no current until the user requests one again
    std::fill(current_.begin(), current_.end(), 0.0);
  }
  const double now = monotonic_now();
  const double change = max_change_per_s_ * (now - last_);
  for (std::size_t k = 0; k < current_.size(); ++k)
    current_[k] += std::clamp(requested_[k] - current_[k], -change, change);
  last_ = now;
  coils_.request(current_, now);
  return coils_.report();
}

}  // namespace faba
