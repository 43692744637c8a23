#pragma once
#include <functional>
#include <vector>

#include "app/loop/limits.h"
#include "control/controller.h"
#include "rig/rig.h"

namespace faba {

/// One turn of the loop, as sinks see it.
struct Tick {
  std::uint64_t index;
  const Observation& seen;
  const Estimate& estimate;
  const Target& target;
  const Command& command;  ///< after the limits
  bool limited;            ///< the limits changed it
};

/// Somebody who records.
class Sink {
 public:
  virtual ~Sink() = default;
  virtual void take(const Tick& t) = 0;
};

/// The parts of a control loop. They outlive it, or are exchanged between two turns.
struct Loop {
  Rig& rig;
  Estimator* estimator;
  Reference* reference;
  Controller* controller;
  Limits& limits;
  double frame_period = 0;  ///< s; stands for the time step in the very first turn
  std::vector<Sink*> sinks;
  std::function<void()> between;  ///< called before every turn, when parts may be exchanged

  std::uint64_t next = 0;  ///< index of the next turn; a resumed loop starts where it was
  double last_t = 0;       ///< time stamp of the frame before, s
  Command last;            ///< written in the turn before
};

/// One turn: read -> estimate -> reference -> control -> limit -> write -> sinks. Returns false when the rig
/// has no more frames, and then nothing was written. Who calls it sees to it that the rig is made safe; run()
/// does. Throws Error(usage) when the controller gives another number of currents than there are coils.
bool turn(Loop& loop);

/// The only control loop in the program; simulation, replay and hardware differ only in the rig. Takes turns
/// until turn `end`, until the rig has no more frames, or until `keep_running` (asked after every turn) says
/// no. The rig is made safe on every way out.
void run(Loop& loop, std::uint64_t end, const std::function<bool()>& keep_running);

}  // namespace faba
