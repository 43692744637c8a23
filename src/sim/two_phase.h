#pragma once
#include <cstdint>
#include <span>
#include <vector>

#include "core/threads/parallel.h"
#include "sim/arena.h"
#include "sim/sites.h"

namespace faba {

/// Simultaneous exclusion (theory D4): all agents propose a move ("wish"), and each free site accepts the
/// wish with the smallest hash(key, site, agent). Set operations on bitmaps of the sites, which do not depend
/// on the order of the agents or the number of threads: each thread marks the sites that its agents request
/// once and more than once; a free site that one agent requests is granted to it; only the wishes for the
/// others are compared; granted agents leave their sites at the end. Blocks of sites that no agent leaves or
/// requests are skipped. Between two calls no bit is set.
///
/// The bitmaps of a large arena do not fit into the nearer caches, and agents are in no spatial order: each
/// thread first sorts its wishes by regions of sites whose bitmaps do fit.
class TwoPhase {
 public:
  explicit TwoPhase(const Grid& grid) : grid_(grid) {}
  /// The next calls are for another grid.
  void use(const Grid& grid) { grid_ = grid; }

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
  /// Bits of the same 64 sites, side by side: one access fetches both. First the sites that are requested at
  /// least once and more than once; grant() leaves the free ones with one request and with several.
  struct Requests {
    std::uint64_t once = 0, more = 0;
  };
  /// The wishes for moves from a region of sites: elements of Part::wishes.
  struct Bucket {
    std::size_t begin = 0, end = 0;
  };
  /// The wishes of a part of the agents.
  struct Part {
    std::size_t begin = 0, end = 0;  ///< agents
    std::vector<Bucket> buckets;
    /// Sorted into buckets by sort(); decide() moves those that are not granted to the front.
    std::vector<Wish> wishes;
    std::vector<Wish> contested;
    std::size_t contests = 0, refusals = 0;  ///< used elements of the lists
    std::vector<Requests> requests;          ///< of each word of sites; in the first part those of all
    Sites left;                              ///< sites that granted agents leave
    std::vector<std::uint8_t> used;          ///< 1 for blocks of sites from or to which an agent moves
    std::span<Wish> refused() { return std::span(wishes).first(refusals); }
  };
  /// Calls use(word) for all words in used blocks of [first_block, end_block).
  template <class Use>
  void each_used_word(std::size_t first_block, std::size_t end_block, Use&& use) const;
  void prepare(std::size_t agents, std::size_t words, unsigned parts);
  void sort(std::span<const float> x, std::span<const float> y, std::span<const float> to_x,
            std::span<const float> to_y, Part& part) const;
  static void mark(Part& part);
  void grant(const Sites& taken, std::size_t first_block, std::size_t end_block);
  void decide(Part& part) const;
  void settle(std::uint64_t key);
  void update(Sites& taken, std::size_t first_block, std::size_t end_block);
  void follow(Sites& taken, std::uint64_t key);

  Grid grid_;
  std::vector<Part> parts_;
  std::size_t parts_used_ = 0;
  std::size_t words_ = 0, blocks_ = 0;  ///< of the bitmaps
  /// Of the wanted sites, in order: agent with the smallest priority so far. Their number before each
  /// word.
  std::vector<std::uint64_t> best_;
  std::vector<std::uint32_t> winner_, before_;
  std::vector<std::uint32_t> ranks_;  ///< of the sites of the contested wishes
};

}  // namespace faba
