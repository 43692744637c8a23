#pragma once
#include <array>
#include <optional>

#include "sim/arena.h"

namespace faba {

/// What a place is made from.
struct PlaceDraw {
  std::array<double, 3> u{};  ///< uniform numbers in (0, 1)
  std::size_t cell = 0;       ///< number of the cell in its swarm, from 0 on
  std::uint32_t attempt = 0;  ///< how often this cell was placed in vain
};

/// Where a swarm begins.
class Start {
 public:
  virtual ~Start() = default;
  /// A candidate position of a cell, m, world frame; none when the numbers lead nowhere. Those, and
  /// candidates outside the arena or on an occupied grid cell, are drawn again by the caller.
  virtual std::optional<Vec2> place(const PlaceDraw& d) const = 0;
};

struct StartContext {
  const Arena* arena = nullptr;  ///< outlives the start
};
using StartRegistry = Registry<Start, StartContext>;

}  // namespace faba
