#include "app/loop/loop.h"

#include <algorithm>
#include <cmath>

namespace faba {

bool run_cycle(Loop& loop) {
  Observation seen;
  if (loop.between) loop.between();
  if (!loop.rig.read(seen)) return false;
  const double dt = loop.next == 0 ? loop.frame_period : seen.t - loop.last_t;
  const Estimate estimate = loop.estimator->update(seen, loop.last);
  const Target target = loop.reference->update(estimate);
  Command command = loop.controller->update(estimate, target, dt);
  if (seen.coils_off) loop.limits.coils_off();
  // The coils were de-energised: the first change from zero has one frame period, as in the guard.
  const double changing = seen.coils_off ? std::min(dt, loop.frame_period) : dt;
  const bool limited = loop.limits.apply(command, changing, seen.age);
  loop.rig.write(command);
  loop.last = command;
  loop.last_t = seen.t;
  for (Sink* s : loop.sinks) s->take({loop.next, seen, estimate, target, command, limited});
  ++loop.next;
  return true;
}

void run(Loop& loop, std::uint64_t end, const std::function<bool()>& keep_running) {
  struct Guard {
    Rig& rig;
    ~Guard() { rig.safe(); }
  } guard{loop.rig};
  while (loop.next < end && run_cycle(loop))
    if (!keep_running()) break;
}

}  // namespace faba
