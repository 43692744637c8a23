#pragma once
#include "core/frame.h"
#include "sim/agent_model.h"

namespace faba {

/// Grid of square sites, one camera pixel wide, that covers the arena; site (0, 0) is at the lower left.
struct Grid {
  int columns = 0, rows = 0;
  float cell = 0;           ///< edge length, m
  float left = 0, low = 0;  ///< world position of the lower left corner, m

  /// Index of the site at a point; points outside are assigned to the nearest border site.
  std::int32_t index(float x, float y) const {
    const auto clamped = [](float v, int n) {  // NaN is assigned to the first site
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

/// Outline in the image: a circle if radius_px > 0, otherwise the rectangle of the view.
struct Outline {
  Vec2 centre_image;
  double radius_px = 0;
};

/// Agents that an arena checks together before it processes them one by one.
constexpr std::size_t kArenaRow = 64;

/// Region accessible to cells. World frame, origin at the centre of the arena.
class Arena {
 public:
  virtual ~Arena() = default;
  /// Moves the proposed positions of the block back inside. The x and y columns still have the present
  /// positions.
  virtual void confine(State& s, const StepContext& c) const = 0;
  /// Distance to the nearest wall, m; negative outside.
  virtual double depth(Vec2 p_world) const = 0;
  /// The point `depth` m inside the wall at which cells that swim along `direction` (rad, world) accumulate.
  /// `across` in (-1, 1) is the position along the wall, perpendicular to `direction`.
  virtual Vec2 wall_point(double direction, double across, double depth) const = 0;
  virtual Grid grid() const = 0;
  virtual Frame frame() const = 0;
  virtual Outline outline() const = 0;
  /// True if rejected moves can make cells overlap, so that exclusion must resolve them.
  virtual bool needs_exclusion() const { return false; }
};

struct ArenaContext {
  Scale scale;
};
using ArenaRegistry = Registry<Arena, ArenaContext>;

}  // namespace faba
