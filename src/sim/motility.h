#pragma once
#include "sim/arena.h"

namespace faba {

/// How air takes the cells' strength: what is left of their speed, and who has stopped responding.
class Motility {
 public:
  virtual ~Motility() = default;
  virtual std::vector<ColumnSpec> columns() const = 0;
  /// Sets the columns for agents [begin, end) that have been in air for the exposure time already.
  virtual void start(State& s, std::size_t begin, std::size_t end, std::uint64_t seed) const = 0;
  /// Fraction of the speed left after `t` s of simulation.
  virtual double vigour(double t) const = 0;
  /// Advances the dose of the block's agents and silences those that have had theirs (response column to 0).
  virtual void step(State& s, const StepContext& c) const = 0;
};

struct MotilityContext {
  const Arena* arena = nullptr;
  double exposure = 0;  ///< s in air before the run
};
using MotilityRegistry = Registry<Motility, MotilityContext>;

}  // namespace faba
