#pragma once
#include <cstdint>
#include <span>
#include <vector>

#include "core/parallel.h"
#include "sim/arena.h"

namespace faba {

/// What a grid cell is to those who want to enter it.
enum Occupancy : std::uint8_t { kFree = 0, kTaken = 255 };

/// All agents propose at once, and each grid cell that was free takes the best of those who want it (theory
/// D4): the one of smallest hash(key, grid cell, agent). In four passes over wishes, none of which depends on
/// order or thread count: wishes are sorted by the stripe of the grid that they concern; each stripe is
/// decided by one thread on its own, in its cache and without atomics; those who go leave their grid cells;
/// the others are kept back. 24 bytes per agent.
class TwoPhase {
 public:
  explicit TwoPhase(const Grid& grid);

  /// Who goes first where several want to go: the smallest.
  static std::uint64_t priority(std::uint64_t key, std::int32_t cell, std::uint32_t agent);

  /// The grid cells that are taken, by index.
  using Cells = std::vector<std::uint8_t>;

  /// Moves agents from (x, y) to (to_x, to_y) on `taken`, or sets their proposal back to where they are. With
  /// `follow` those who were refused try again after those before them have left.
  void resolve(std::span<const float> x, std::span<const float> y, std::span<float> to_x,
               std::span<float> to_y, Cells& taken, std::uint64_t key, bool follow, Pool& pool);

 private:
  /// An agent that wants to leave its grid cell for another one.
  struct Wish {
    std::uint32_t agent;
    std::int32_t from, to;  ///< `to` is kGranted for those that follow() lets go
  };
  /// The wishes of one block of agents that concern one stripe.
  struct Segment {
    std::uint32_t begin = 0, end = 0, granted = 0, refused = 0;
  };
  void sort(std::span<const float> x, std::span<const float> y, std::span<const float> to_x,
            std::span<const float> to_y, std::size_t block);
  void decide(std::size_t stripe, Cells& taken, std::uint64_t key);
  void follow(Cells& taken, std::uint64_t key);

  Segment& segment(std::size_t block, std::size_t stripe) { return segment_[block * stripes_ + stripe]; }

  Grid grid_;
  unsigned shift_ = 0;  ///< grid cells of equal index >> shift_ are a stripe
  std::size_t stripes_ = 0, blocks_ = 0;
  std::vector<Wish> wish_;              ///< by block of agents, in it by stripe
  std::vector<Segment> segment_;        ///< of them, in the same order
  std::vector<std::int32_t> left_;      ///< per segment: grid cells that those leave who go
  std::vector<std::uint32_t> refused_;  ///< per segment: wishes of those who do not
};

}  // namespace faba
