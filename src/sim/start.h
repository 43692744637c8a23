#pragma once
#include <array>
#include <optional>

#include "sim/arena.h"

namespace faba {

/// Where a swarm begins.
class Start {
 public:
  virtual ~Start() = default;
  /// A candidate position, m, world frame, from three uniform numbers in (0, 1); none when these numbers lead
  /// nowhere. Those, and candidates outside the arena or on an occupied grid cell, are drawn again by the
  /// caller.
  virtual std::optional<Vec2> place(const std::array<double, 3>& u) const = 0;
};

struct StartContext {
  const Arena* arena = nullptr;  ///< outlives the start
};
using StartRegistry = Registry<Start, StartContext>;

}  // namespace faba
