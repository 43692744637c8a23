#pragma once
#include <memory>
#include <optional>
#include <vector>

#include "core/threads/parallel.h"
#include "field/kernels/field_table.h"
#include "sim/exclusion.h"
#include "sim/motility.h"
#include "sim/start.h"

namespace faba {

/// One type of cell in the drop: agents [begin, end).
struct Population {
  std::size_t begin = 0, end = 0;
  int polarity = -1;      ///< +1 north-seeking: swims along B; -1 south-seeking
  double responding = 1;  ///< initial responsive fraction
  std::optional<double>
      heading;  ///< initial heading of responsive cells, rad, world frame; uniform when absent
  std::shared_ptr<const AgentModel> model;
  std::shared_ptr<const Start> start;
};

/// Constants of a run.
struct WorldParts {
  std::shared_ptr<const Field> field;
  std::optional<FieldTable> table;  ///< of `field` over the arena; empty for a homogeneous field
  std::shared_ptr<const Arena> arena;
  std::shared_ptr<const Motility> motility;
  std::vector<Population> populations;
  Exclusion::Params exclusion;
  double dt = 1e-3;  ///< s
  std::uint64_t seed = 1;
};

/// A swarm in the field of coils: constants plus one State. The same parts, seed and commands give bitwise
/// equal results for any pool.
class World {
 public:
  /// Places every cell and draws its initial values. Throws Error(usage) if a swarm does not fit into its
  /// start region.
  World(WorldParts parts, Pool& pool);

  /// Advances time by dt: currents -> field -> motility -> agents -> arena -> exclusion -> time.
  void step();
  /// Throws Error(internal) with agent, step and model if a position is not finite.
  void check_finite() const;
  /// Resumes from a saved state of a world with the same parts; views of the columns stay valid.
  void restore(const State& saved);

  const State& state() const { return state_; }
  const WorldParts& parts() const { return parts_; }
  /// Sets the commanded currents, A, one per coil. Throws Error(usage) for a wrong number of currents.
  void command(const std::vector<double>& current);
  /// Replaces the model of a population. Cells keep position and heading; all other values are drawn again.
  void exchange_model(std::size_t population, std::shared_ptr<const AgentModel> model);
  std::uint64_t responding() const;  ///< number of responsive cells

 private:
  void place_all();
  void set_headings(const Population& p);
  void advance_currents();

  WorldParts parts_;
  Pool& pool_;
  Exclusion exclusion_;
  std::vector<double> current_gain_;  ///< per coil: 1 - exp(-dt / lag)
  std::vector<float> to_x_, to_y_;    ///< proposed positions; unused without exclusion
  State state_;
};

}  // namespace faba
