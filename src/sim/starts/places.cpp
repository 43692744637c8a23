// Start at listed positions: cell n at position n modulo the length of the list, with a normal scatter for
// the uncertainty of positions. The scatter also separates cells that would share a pixel.
#include <cmath>

#include "core/portable_math.h"
#include "core/schema.h"
#include "sim/arena.h"
#include "sim/start.h"

namespace faba {
namespace {

constexpr double kCrowded = 10;  // attempts after which the scatter has doubled

// Moves a position outside the edge to the edge, on the line to the centre of the arena, by bisection.
Vec2 inside(const Arena& arena, Vec2 at) {
  if (arena.depth(at) >= 0) return at;
  double in = 0, out = 1;  // fractions of the distance from the centre
  for (int i = 0; i < 40; ++i) {
    const double middle = (in + out) / 2;
    (arena.depth(middle * at) >= 0 ? in : out) = middle;
  }
  return in * at;
}

/// At listed positions in the image.
class StartPlaces final : public Start {
 public:
  struct Params {
    std::vector<Vec2> positions_px;
    double scatter_px = 1;
  };
  static Schema<Params> schema();
  StartPlaces(const Params& p, const StartContext& c) : scatter_(p.scatter_px * c.arena->frame().m_per_px) {
    for (const Vec2 at : p.positions_px)
      positions_.push_back(inside(*c.arena, c.arena->frame().world_from_image(at)));
    if (positions_.empty()) positions_.emplace_back();
  }
  std::optional<Vec2> place(const PlaceDraw& d) const override {
    const auto a = portable::sincos(2 * portable::kPi * d.u[1]);
    // The scatter increases until a free site is found.
    const double far = scatter_ * (1 + d.attempt / kCrowded) * std::sqrt(-2 * portable::log(d.u[0]));
    return positions_[d.cell % positions_.size()] + far * Vec2{a.cos, a.sin};
  }

 private:
  std::vector<Vec2> positions_;  ///< m, world
  double scatter_;               ///< m
};

Schema<StartPlaces::Params> StartPlaces::schema() {
  return Schema<Params>("places", "At listed positions in the image, such as detected cells")
      .add("places_px", &Params::positions_px,
           {.unit = "px",
            .min = -1e5,
            .max = 1e5,
            .doc = "Positions in the image, y down, assigned to cells in turn; the centre of the arena when "
                   "absent"})
      .add("scatter_px", &Params::scatter_px,
           {.unit = "px",
            .min = 0,
            .max = 1e4,
            .doc = "Standard deviation of the scatter in x and y: uncertainty of the positions"});
}

}  // namespace

void add_start_places(StartRegistry& r) { r.add<StartPlaces>(); }

}  // namespace faba
