#pragma once
#include <functional>
#include <vector>

#include "app/loop/limits.h"
#include "control/controller.h"
#include "rig/rig.h"

namespace faba {

/// Data of one control cycle, for sinks.
struct Tick {
  std::uint64_t index;
  const Observation& seen;
  const Estimate& estimate;
  const Target& target;
  const Command& command;  ///< after the limits
  bool limited;            ///< whether the limits changed it
};

/// Receives the data of every control cycle, for example to record it.
class Sink {
 public:
  virtual ~Sink() = default;
  virtual void take(const Tick& t) = 0;
};

/// The parts of a control loop. They must outlive it, or are exchanged between two cycles.
struct Loop {
  Rig& rig;
  Estimator* estimator;
  Reference* reference;
  Controller* controller;
  Limits& limits;
  double frame_period = 0;  ///< s; used as the time step of the first cycle
  std::vector<Sink*> sinks;
  std::function<void()> between;  ///< called before every cycle, when parts may be exchanged

  std::uint64_t next = 0;  ///< index of the next cycle; restored when a run is resumed
  double last_t = 0;       ///< time stamp of the previous frame, s
  Command last;            ///< command of the previous cycle
};

/// The first half of a control cycle: what is known when the controller decides.
struct CycleInput {
  Observation seen;
  double dt = 0;  ///< s, since the previous cycle
  Estimate estimate;
  Target target;
};
/// read -> estimate -> reference. Returns false if the rig has no more frames.
bool begin_cycle(Loop& loop, CycleInput& cycle);
/// limit -> write -> sinks, for the command that was decided. Throws Error(usage) if the number of currents
/// is not the number of coils.
void end_cycle(Loop& loop, const CycleInput& cycle, Command command);

/// One control cycle: read -> estimate -> reference -> control -> limit -> write -> sinks. Returns false if
/// the rig has no more frames; then nothing was written. The caller must call Rig::safe() at the end, as
/// run() does. Throws Error(usage) if the number of currents of the controller is not the number of coils.
bool run_cycle(Loop& loop);

/// The only control loop in the program; simulation, replay and hardware differ only in the rig. Runs cycles
/// until cycle `end`, until the rig has no more frames, or until `keep_running` (called after every cycle)
/// returns false. Calls Rig::safe() in any case, also on exceptions.
void run(Loop& loop, std::uint64_t end, const std::function<bool()>& keep_running);

}  // namespace faba
