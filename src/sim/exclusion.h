#pragma once
#include <span>
#include <vector>

#include "core/schema.h"
#include "core/threads/parallel.h"
#include "sim/arena.h"
#include "sim/two_phase.h"

namespace faba {

/// At most one cell per site of the occupancy grid; a site is one camera pixel (theory A1, A2, D4).
/// - `two-phase` (default): all cells propose moves from the state at the start of the step. Sites occupied
///   then are closed (with `follow`, open after their cell has left, up to eight sweeps). If several cells
///   propose the same free site, the one with the smallest hash(seed, step, site, agent) moves, the others
///   stay. Independent of order and number of threads.
/// - `published`: the loop of the thesis: in ascending order of agents, in place, one thread. A site left in
///   this iteration is free for later agents. `collision` determines the move of a blocked agent.
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
  /// Occupies the site at `p_world` for one agent; false if it is not free.
  bool place(Vec2 p_world);
  /// Position of a cell placed at `p_world`: the centre of its site with integer_positions.
  Vec2 snapped(Vec2 p_world) const;
  /// Marks the sites of all agents as occupied; call once before the first resolve() and after a restore.
  void occupy(const State& s);
  /// Accepts or refuses the proposal of every agent; updates the x and y columns.
  void resolve(State& s, std::span<float> to_x, std::span<float> to_y, Pool& pool);

 private:
  void published(State& s, std::span<const float> to_x, std::span<const float> to_y);
  void move_or_turn_aside(float& x, float& y, float to_x, float to_y, std::int32_t home, std::int32_t site);
  std::int32_t last_free(std::int32_t from, std::int32_t to) const;

  Params p_;
  Grid grid_;
  std::uint64_t seed_;
  Sites taken_;  ///< by a cell, or outside of the edge
};

}  // namespace faba
