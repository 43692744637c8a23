#pragma once
#include "core/archive.h"
#include "core/signals.h"

namespace faba {

/// The seam between software and world: eyes and hands. The rig owns time: read() blocks until the next
/// frame, whether that means waiting for a camera or stepping a simulation.
class Rig {
 public:
  virtual ~Rig() = default;
  /// The next frame; false when there are no more.
  virtual bool read(Observation& out) = 0;
  virtual void write(const Command& c) = 0;
  /// All currents to zero. Must work at any moment and not throw.
  virtual void safe() noexcept = 0;
  virtual void archive(Archive&) {}  ///< its memory, for checkpoints
};

}  // namespace faba
