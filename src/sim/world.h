#pragma once
#include <memory>
#include <optional>
#include <vector>

#include "core/parallel.h"
#include "field/kernels/field_table.h"
#include "sim/exclusion.h"
#include "sim/motility.h"
#include "sim/start.h"

namespace faba {

/// One kind of cell among those in the drop: agents [begin, end).
struct Population {
  std::size_t begin = 0, end = 0;
  int polarity = -1;              ///< +1 north-seeking: swims along B; -1 south-seeking
  double responding = 1;          ///< fraction that feels the field at all
  std::optional<double> heading;  ///< in which these head at first, rad, world frame; any when absent
  std::shared_ptr<const AgentModel> model;
  std::shared_ptr<const Start> start;
};

/// Everything about a run that does not change while it runs.
struct WorldParts {
  std::shared_ptr<const Field> field;
  std::optional<FieldTable> table;  ///< of `field` over the arena; empty for one that is the same everywhere
  std::shared_ptr<const Arena> arena;
  std::shared_ptr<const Motility> motility;
  std::vector<Population> populations;
  Exclusion::Params exclusion;
  double dt = 1e-3;  ///< s
  std::uint64_t seed = 1;
};

/// A swarm under coils: constants plus one State. Equal parts, seed and commands give equal bits for any
/// pool.
class World {
 public:
  /// Places every cell and draws what it is born with. Throws Error(usage) when a swarm does not fit its
  /// start.
  World(WorldParts parts, Pool& pool);

  /// Advances time by dt: currents -> field -> motility -> agents -> arena -> exclusion -> time.
  void step();
  /// Throws Error(internal) naming agent, step and model when a position is not finite.
  void check_finite() const;
  /// Continues from a saved state of a world made of the same parts.
  void restore(State saved);

  const State& state() const { return state_; }
  const WorldParts& parts() const { return parts_; }
  /// Currents for the coils, A, one per coil. Throws Error(usage) for another number of them.
  void command(const std::vector<double>& current);
  /// From now on a population obeys another law. Its cells stay where they are and head where they do;
  /// everything else is drawn as for newborn ones.
  void exchange_model(std::size_t population, std::shared_ptr<const AgentModel> model);
  std::uint64_t responding() const;  ///< cells that still feel the field

 private:
  void place_all();
  void head(const Population& p);
  void advance_currents();

  WorldParts parts_;
  Pool& pool_;
  Exclusion exclusion_;
  std::vector<double> follow_;      ///< per coil: fraction of the way to the command covered in dt
  std::vector<float> to_x_, to_y_;  ///< proposals; unused without exclusion
  State state_;
};

}  // namespace faba
