#pragma once
#include "core/frame.h"
#include "sim/agent_model.h"

namespace faba {

/// Square cells one camera pixel wide that cover the arena; cell (0, 0) is at the lower left.
struct Grid {
  int columns = 0, rows = 0;
  float cell = 0;           ///< edge length, m
  float left = 0, low = 0;  ///< world position of the lower left corner, m

  /// Index of the cell that holds a point; points outside count to the nearest border cell.
  std::int32_t index(float x, float y) const {
    const auto clamped = [](float v, int n) {  // what is no number counts to the first
      const float last = float(n - 1), from_zero = v > 0 ? v : 0;
      return std::int32_t(from_zero < last ? from_zero : last);
    };
    return clamped((y - low) / cell, rows) * columns + clamped((x - left) / cell, columns);
  }
  Vec2 centre(std::int32_t i) const {
    const int column = i % columns, row = i / columns;
    return {double(left) + double(cell) * (column + 0.5), double(low) + double(cell) * (row + 0.5)};
  }
};

/// The outline, for pictures: a circle when radius > 0, else the rectangle of the view.
struct Outline {
  Vec2 centre_image;
  double radius_px = 0;
};

/// Agents that an arena looks at together before it goes through them one by one.
constexpr std::size_t kArenaRow = 64;

/// Where cells can be. World frame, origin at the arena's centre.
class Arena {
 public:
  virtual ~Arena() = default;
  /// Brings the proposed positions of the block back inside; the present ones are still in the x and y
  /// columns.
  virtual void confine(State& s, const StepContext& c) const = 0;
  /// Distance to the nearest wall, m; negative outside.
  virtual double depth(Vec2 p_world) const = 0;
  /// The point `depth` m inside the wall met by going from the centre across the swarm: `across` in (-1, 1)
  /// runs along the wall perpendicular to `direction` (rad, world). This is where cells that swim along
  /// `direction` pile up.
  virtual Vec2 wall_point(double direction, double across, double depth) const = 0;
  virtual Grid grid() const = 0;
  virtual Frame frame() const = 0;
  virtual Outline outline() const = 0;
  /// Whether moves that it undoes may put cells on top of each other, unless exclusion sees to it.
  virtual bool needs_exclusion() const { return false; }
};

struct ArenaContext {
  Scale scale;
};
using ArenaRegistry = Registry<Arena, ArenaContext>;

}  // namespace faba
