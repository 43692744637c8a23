#pragma once
#include <pybind11/pybind11.h>

#include <memory>

#include "app/loop/loop.h"
#include "control/controller.h"

namespace faba::python {

/// Desired mean velocity of the swarm, m/s, world frame.
struct Drift {
  Vec2 velocity;
};

/// Copy of the data of one control cycle; a Tick has references only.
struct TickCopy {
  std::uint64_t index = 0;
  std::shared_ptr<const Observation> seen;
  Estimate estimate;
  Target target;
  Command command;
  bool limited = false;

  explicit TickCopy(const Tick& t)
      : index(t.index),
        seen(std::make_shared<const Observation>(t.seen)),
        estimate(t.estimate),
        target(t.target),
        command(t.command),
        limited(t.limited) {}
};

/// Currents for a drift at `at` (m, world): a field of one field unit per pixel of drift and iteration, as
/// Basic cells need it; other cells swim along it at their own speed.
Command drift_command(const ControlContext& c, Vec2 at, const Drift& drift);

/// The classes Observation, Estimate, Group, Target, Tick, Drift and Context.
void bind_loop_values(pybind11::module_& m);

}  // namespace faba::python
