#pragma once
#include <span>
#include <vector>

#include "core/parallel.h"
#include "core/schema.h"
#include "sim/arena.h"
#include "sim/two_phase.h"

namespace faba {

/// At most one cell per grid cell, a grid cell being one camera pixel (theory A1, A2, D4).
/// - `two-phase` (default): all cells propose from the state at the beginning of the step; a grid cell
/// occupied then is
///   closed (with `follow`, open again once its owner has left, up to eight sweeps); of several that want a
///   free one the smallest hash(seed, step, grid cell, agent) wins, the others stay. Independent of order and
///   thread count.
/// - `published`: the thesis's loop: ascending agent number, in place, one thread; a grid cell left in this
/// iteration is
///   free for later agents. `collision` says what a blocked agent does.
/// - `none`: cells overlap.
class Exclusion {
 public:
  enum class Order { two_phase, published, none };
  enum class Collision { stay, last_free, axis_split };
  struct Params {
    Order order = Order::two_phase;
    bool follow = false;
    Collision collision = Collision::stay;
    bool integer_positions = false;
  };
  static Schema<Params> schema();

  Exclusion(const Params& p, const Arena& arena, std::uint64_t seed);

  bool active() const { return p_.order != Order::none; }
  const Params& params() const { return p_; }
  /// Takes the grid cell at `p_world` for one agent; false when it is not free.
  bool place(Vec2 p_world);
  /// Where a cell at `p_world` really stands: the centre of its grid cell with integer_positions.
  Vec2 snapped(Vec2 p_world) const;
  /// Reads who stands where from the state; call once before the first resolve() and after a restart.
  void occupy(const State& s);
  /// Moves every agent to its proposal or lets it stay; x and y columns are updated.
  void resolve(State& s, std::span<float> to_x, std::span<float> to_y, Pool& pool);

 private:
  void published(State& s, std::span<const float> to_x, std::span<const float> to_y);
  std::int32_t last_free(std::int32_t from, std::int32_t to) const;

  Params p_;
  Grid grid_;
  std::uint64_t seed_;
  TwoPhase two_phase_;
  TwoPhase::Cells taken_;  ///< kFree or kTaken for every grid cell
};

}  // namespace faba
