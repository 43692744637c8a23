#pragma once
#include "sim/arena.h"

namespace faba {

/// Loss of motility in air: reduction of speed, and loss of the response to the field.
class Motility {
 public:
  virtual ~Motility() = default;
  virtual std::vector<ColumnSpec> columns() const = 0;
  /// Sets the columns of agents [begin, end) for the air exposure time before the run.
  virtual void start(State& s, std::size_t begin, std::size_t end, std::uint64_t seed) const = 0;
  /// Fraction of the initial speed after `t` s of simulation.
  virtual double speed_factor(double t) const = 0;
  /// Advances the dose of the agents; sets response to 0 if the dose exceeds the tolerance.
  virtual void step(State& s, const StepContext& c) const = 0;
};

struct MotilityContext {
  const Arena* arena = nullptr;
  double exposure = 0;  ///< s, air exposure time before the run
};
using MotilityRegistry = Registry<Motility, MotilityContext>;

}  // namespace faba
