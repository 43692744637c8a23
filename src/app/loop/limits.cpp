#include "app/loop/limits.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "core/counted.h"

namespace faba {

Schema<Limits::Params> Limits::schema() {
  return Schema<Params>("limits", "Limits of the commands that the control loop sends to the coils")
      .add("max_current", &Params::max_current,
           {.unit = "A", .min = 0, .max = 1000, .doc = "Maximum current in any coil", .source = "assumed"})
      .add("max_slew", &Params::max_slew,
           {.unit = "A/s",
            .min = 1e-6,
            .max = 1e9,
            .doc = "Maximum rate of change of any current; default: unlimited"})
      .add("max_frame_age", &Params::max_frame_age,
           {.unit = "s",
            .min = 1e-3,
            .max = 1e6,
            .doc = "Maximum age of a picture; for an older one all currents are set to zero"});
}

double Limits::limited(std::size_t coil, double current, double dt) const {
  const double limit = max_currents_.empty() ? p_.max_current : std::min(max_currents_[coil], p_.max_current);
  const double i = std::isfinite(current) ? std::clamp(current, -limit, limit) : 0;
  if (!p_.max_slew) return i;
  const double change = *p_.max_slew * std::max(0.0, dt);
  return std::clamp(i, last_[coil] - change, last_[coil] + change);
}

bool Limits::apply(Command& c, double dt, double frame_age) {
  if (!max_currents_.empty() && c.current.size() != max_currents_.size())
    throw Error(Errc::usage, "controller",
                fmt::format("the command has {}, but the field has {}; give one current per coil",
                            counted(c.current.size(), "current"), counted(max_currents_.size(), "coil")));
  const std::vector<double> requested = c.current;
  last_.resize(c.current.size(), 0.0);
  if (!(frame_age <= p_.max_frame_age)) {
    std::fill(c.current.begin(), c.current.end(), 0.0);
  } else {
    if (wired_) wired_(c.current);
    for (std::size_t k = 0; k < c.current.size(); ++k) c.current[k] = limited(k, c.current[k], dt);
  }
  last_ = c.current;
  return c.current != requested;
}

}  // namespace faba
