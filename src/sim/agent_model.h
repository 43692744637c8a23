#pragma once
#include <cstddef>
#include <cstdint>
#include <span>
#include <string>
#include <vector>

#include "core/frame.h"
#include "core/registry.h"
#include "core/swarm_motion.h"
#include "sim/state.h"

namespace faba {

/// Input of AgentModel::step() for agents [begin, end).
struct StepContext {
  std::size_t begin = 0, end = 0;
  std::uint64_t seed = 0;
  double dt = 0;                  ///< s
  std::span<const float> bx, by;  ///< field at each agent of the block, T; index 0 is agent `begin`
  std::span<float> to_x,
      to_y;                ///< proposed positions, m, indexed by agent; may be the x and y columns themselves
  float speed_factor = 1;  ///< fraction of the initial swimming speed (motility law)
};

/// A quantity that a model stores for every agent.
struct ColumnSpec {
  std::string name, unit, doc;
};

/// A field that is just strong enough to move the cells of a model.
struct WeakestField {
  double tesla = 0;         ///< 0: any field moves them; infinity: none does
  std::string reason = {};  ///< why a weaker field does not move them; ends a sentence
};

/// A law of motion. Stateless: all state is in columns. One virtual call per block of agents.
class AgentModel {
 public:
  virtual ~AgentModel() = default;
  virtual std::vector<ColumnSpec> columns() const = 0;
  /// Draws the initial values of agents [begin, end).
  virtual void start(State& s, std::size_t begin, std::size_t end, std::uint64_t seed) const = 0;
  /// Advances the block by dt; writes positions to c.to_x, c.to_y, everything else to the columns.
  virtual void step(State& s, const StepContext& c) const = 0;
  /// Maximum time step, s, at which the integrator has its documented accuracy in a field of `b_max` T.
  virtual double longest_step(double b_max) const = 0;
  /// The field below which cells move as without a field during `time` s, for notes on weak fields.
  virtual WeakestField weakest_field(double /*time*/) const { return {}; }
  /// How a swarm of typical cells moves in a uniform field.
  virtual SwarmMotion motion() const = 0;
};

/// Context for the construction of a model.
struct ModelContext {
  Scale scale;
  double step = 0;  ///< dt of the world, s
};
using ModelRegistry = Registry<AgentModel, ModelContext>;

}  // namespace faba
