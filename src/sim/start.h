#pragma once
#include <array>
#include <optional>

#include "sim/arena.h"

namespace faba {

/// Random numbers and indices for one candidate position.
struct PlaceDraw {
  std::array<double, 3> u{};  ///< uniform numbers in (0, 1)
  std::size_t cell = 0;       ///< index of the cell in its swarm, from 0
  std::uint32_t attempt = 0;  ///< failed attempts for this cell
};

/// Distribution of the initial positions of a swarm.
class Start {
 public:
  virtual ~Start() = default;
  /// A candidate position of a cell, m, world frame; may be empty. The caller draws again after an empty
  /// result, and for candidates outside the arena or on an occupied site.
  virtual std::optional<Vec2> place(const PlaceDraw& d) const = 0;
};

struct StartContext {
  const Arena* arena = nullptr;  ///< must outlive the start
};
using StartRegistry = Registry<Start, StartContext>;

}  // namespace faba
