#pragma once
#include "sim/agent_model.h"

namespace faba {

/// Clock of the published models (theory A3): they move once per iteration, which is an integer number of
/// steps, and draw a new velocity every `hold` iterations, which the thesis calls inertia.
class Iterations {
 public:
  /// Throws Error(usage) unless an iteration is an integer number of steps.
  Iterations(const ModelContext& c, int hold);

  bool moves(std::uint64_t step) const { return step % steps_ == 0; }
  bool redraws(std::uint64_t step) const { return moves(step) && index(step) % hold_ == 0; }
  std::uint32_t index(std::uint64_t step) const { return std::uint32_t(step / steps_); }

  /// Proposes x + vx, y + vy, or no change between iterations; `m_per_px` scales the held velocities to m.
  void move(State& s, const StepContext& c, float m_per_px) const;
  /// The held velocity: columns vx and vy, in px per iteration.
  static std::vector<ColumnSpec> columns();

 private:
  std::uint64_t steps_, hold_;
};

}  // namespace faba
