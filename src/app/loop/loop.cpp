#include "app/loop/loop.h"

#include <algorithm>
#include <cmath>

namespace faba {

Schema<Limits::Params> Limits::schema() {
  return Schema<Params>("limits", "What the loop lets through to the coils")
      .add("max_current", &Params::max_current,
           {.unit = "A", .min = 0, .max = 1000, .doc = "Largest current in any coil", .source = "assumed"})
      .add("max_slew", &Params::max_slew,
           {.unit = "A/s",
            .min = 1e-6,
            .max = 1e9,
            .doc = "Fastest change of any current; unlimited when absent"})
      .add("max_frame_age", &Params::max_frame_age,
           {.unit = "s",
            .min = 1e-3,
            .max = 1e6,
            .doc = "Older pictures are not acted on: all currents go to zero"});
}

bool Limits::apply(Command& c, double dt, double frame_age) {
  const std::vector<double> asked = c.current;
  last_.resize(c.current.size(), 0.0);
  if (wired_) wired_(c.current);
  for (std::size_t k = 0; k < c.current.size(); ++k) {
    double& i = c.current[k];
    if (!std::isfinite(i) || frame_age > p_.max_frame_age) i = 0;
    const double most = k < most_.size() ? std::min(most_[k], p_.max_current) : p_.max_current;
    i = std::clamp(i, -most, most);
    if (p_.max_slew) i = std::clamp(i, last_[k] - *p_.max_slew * dt, last_[k] + *p_.max_slew * dt);
  }
  last_ = c.current;
  return c.current != asked;
}

void run(Loop& loop, std::uint64_t end, const std::function<bool()>& go_on) {
  struct Guard {
    Rig& rig;
    ~Guard() { rig.safe(); }
  } guard{loop.rig};
  Observation seen;
  while (loop.next < end) {
    if (loop.between) loop.between();
    if (!loop.rig.read(seen)) break;
    const double dt = loop.next == 0 ? loop.frame_period : seen.t - loop.last_t;
    const Estimate estimate = loop.estimator->update(seen, loop.last);
    const Target target = loop.reference->update(estimate);
    Command command = loop.controller->update(estimate, target, dt);
    if (seen.rested) loop.limits.rested();
    // Nothing flowed in the frames before: a change out of rest has one frame's time, as the guard reckons.
    const double changing = seen.rested ? std::min(dt, loop.frame_period) : dt;
    const bool limited = loop.limits.apply(command, changing, seen.age);
    loop.rig.write(command);
    loop.last = command;
    loop.last_t = seen.t;
    for (Sink* s : loop.sinks) s->take({loop.next, seen, estimate, target, command, limited});
    ++loop.next;
    if (!go_on()) break;
  }
}

}  // namespace faba
