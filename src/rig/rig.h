#pragma once
#include "core/archive.h"
#include "core/signals.h"

namespace faba {

/// Interface between the control loop and the experiment: observations in, commands out. The rig owns time:
/// read() blocks until the next frame, by waiting for a camera or by stepping a simulation.
class Rig {
 public:
  virtual ~Rig() = default;
  /// The next frame; false at the end.
  virtual bool read(Observation& out) = 0;
  virtual void write(const Command& c) = 0;
  /// Sets all currents to zero. May be called at any time.
  virtual void safe() noexcept = 0;
  virtual void archive(Archive&) {}  ///< state for checkpoints
};

}  // namespace faba
