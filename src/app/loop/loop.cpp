#include "app/loop/loop.h"

#include <algorithm>
#include <cmath>

namespace faba {

bool begin_cycle(Loop& loop, CycleInput& cycle) {
  if (loop.between) loop.between();
  if (!loop.rig.read(cycle.seen)) return false;
  cycle.dt = loop.next == 0 ? loop.frame_period : cycle.seen.t - loop.last_t;
  cycle.estimate = loop.estimator->update(cycle.seen, loop.last);
  cycle.target = loop.reference->update(cycle.estimate);
  return true;
}

void end_cycle(Loop& loop, const CycleInput& cycle, Command command) {
  const Observation& seen = cycle.seen;
  if (seen.coils_off) loop.limits.coils_off();
  // The coils were de-energised: the first change from zero has one frame period, as in the guard.
  const double changing = seen.coils_off ? std::min(cycle.dt, loop.frame_period) : cycle.dt;
  const bool limited = loop.limits.apply(command, changing, seen.age);
  loop.rig.write(command);
  loop.last = command;
  loop.last_t = seen.t;
  for (Sink* s : loop.sinks) s->take({loop.next, seen, cycle.estimate, cycle.target, command, limited});
  ++loop.next;
}

bool run_cycle(Loop& loop) {
  CycleInput cycle;
  if (!begin_cycle(loop, cycle)) return false;
  end_cycle(loop, cycle, loop.controller->update(cycle.estimate, cycle.target, cycle.dt));
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
