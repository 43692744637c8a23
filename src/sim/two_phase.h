#pragma once
#include <cstdint>
#include <span>
#include <vector>

#include "core/threads/parallel.h"
#include "sim/arena.h"
#include "sim/sites.h"

namespace faba {

/// Simultaneous exclusion (theory D4): all agents propose a move ("wish"), and each free site accepts the
/// wish with the smallest hash(key, site, agent). Four passes, independent of order and number of threads:
/// wishes are sorted by the stripe of the grid that contains their target; each stripe is decided by one
/// thread, in its cache and without atomics, and granted agents leave their sites in it; granted agents leave
/// their sites in other stripes; the proposals of the others are reset. 24 bytes per agent.
class TwoPhase {
 public:
  explicit TwoPhase(const Grid& grid);

  /// Priority of a wish; the smallest value is granted.
  static std::uint64_t priority(std::uint64_t key, std::int32_t cell, std::uint32_t agent);

  /// Updates `taken` for granted moves from (x, y) to (to_x, to_y), and resets refused proposals to (x, y).
  /// With `follow`, refused agents try again after others have left their sites.
  void resolve(std::span<const float> x, std::span<const float> y, std::span<float> to_x,
               std::span<float> to_y, Sites& taken, std::uint64_t key, bool follow, Pool& pool);

 private:
  /// A proposed move to another site.
  struct Wish {
    std::uint32_t agent;
    std::int32_t from, to;  ///< `to` is kGranted for moves granted by follow()
  };
  /// The wishes of one block of agents for one stripe.
  struct Segment {
    std::uint32_t begin = 0, end = 0, left = 0, refused = 0;
  };
  void sort(std::span<const float> x, std::span<const float> y, std::span<const float> to_x,
            std::span<const float> to_y, std::size_t block);
  void decide(std::size_t stripe, Sites& taken, std::uint64_t key);
  void leave(std::size_t stripe, Sites& taken);
  void follow(Sites& taken, std::uint64_t key);

  Segment& segment(std::size_t block, std::size_t stripe) { return segment_[block * stripes_ + stripe]; }

  Grid grid_;
  unsigned shift_ = 0;  ///< sites with equal index >> shift_ form a stripe
  std::size_t stripes_ = 0, blocks_ = 0;
  std::vector<Wish> wish_;              ///< sorted by block of agents, then by stripe
  std::vector<Segment> segment_;        ///< segments of wish_, in the same order
  std::vector<std::int32_t> left_;      ///< per segment: sites in other stripes that granted agents leave
  std::vector<std::uint32_t> refused_;  ///< per segment: refused wishes
};

}  // namespace faba
