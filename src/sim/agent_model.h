#pragma once
#include <cstddef>
#include <cstdint>
#include <span>
#include <string>
#include <vector>

#include "core/frame.h"
#include "core/registry.h"
#include "sim/state.h"

namespace faba {

/// What a law may look at while it advances agents [begin, end).
struct StepContext {
  std::size_t begin = 0, end = 0;
  std::uint64_t seed = 0;
  double dt = 0;                  ///< s
  std::span<const float> bx, by;  ///< field at each agent of the block, T; index 0 is agent `begin`
  std::span<float> to_x,
      to_y;          ///< proposed positions, m, indexed by agent; may be the x and y columns themselves
  float vigour = 1;  ///< what is left of the swimming speed (motility law)
};

/// A quantity that a model keeps for every agent.
struct ColumnSpec {
  std::string name, unit, doc;
};

/// A law of motion. It is const: all its memory is in columns. One virtual call per block of agents.
class AgentModel {
 public:
  virtual ~AgentModel() = default;
  virtual std::vector<ColumnSpec> columns() const = 0;
  /// Draws what each of the agents [begin, end) is born with.
  virtual void start(State& s, std::size_t begin, std::size_t end, std::uint64_t seed) const = 0;
  /// Advances the block by dt; positions go to context.to_x, to_y, everything else into its columns.
  virtual void step(State& s, const StepContext& c) const = 0;
  /// Longest step, s, at which the law's integrator keeps its stated accuracy in a field of `b_max` T.
  virtual double longest_step(double b_max) const = 0;
};

/// What every model may look at when it is built.
struct ModelContext {
  Scale scale;
  double step = 0;  ///< dt of the world, s
};
using ModelRegistry = Registry<AgentModel, ModelContext>;

}  // namespace faba
