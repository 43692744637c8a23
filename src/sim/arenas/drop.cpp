#include <cmath>

#include "core/portable_math.h"
#include "core/schema.h"
#include "core/vectorised.h"
#include "sim/arena.h"
#include "sim/arenas/wall.h"

namespace faba {
namespace {

/// A drop with a circular edge, of which the camera may show only a part (theory A13). Cells leave and enter
/// the view, and slide along the edge without crossing it (B6). Not modelled: pinned drops that are not
/// round.
class Drop final : public Arena {
 public:
  struct Params {
    Vec2 view_px{640, 480};
    Vec2 centre_px{319.5, 239.5};
    double radius_px = 600;
    double wall_alignment = 0;
  };
  static Schema<Params> schema();
  Drop(const Params& p, const ArenaContext& c);

  void confine(State& s, const StepContext& c) const override;
  double depth(Vec2 p_world) const override;
  Vec2 wall_point(double direction, double across, double depth) const override;
  Grid grid() const override;
  Frame frame() const override;
  Outline outline() const override { return {p_.centre_px, p_.radius_px}; }

 private:
  Params p_;
  double m_per_px_;
  float radius_;  ///< m
};

Schema<Drop::Params> Drop::schema() {
  return Schema<Params>("drop", "A round drop, typically larger than the view")
      .add("view_px", &Params::view_px,
           {.unit = "px", .min = 1, .max = 65536, .doc = "Width and height of the image"})
      .add("centre_px", &Params::centre_px,
           {.unit = "px",
            .min = -1e5,
            .max = 1e5,
            .doc = "Centre of the drop in the image, y down; may be outside"})
      .add("radius_px", &Params::radius_px,
           {.unit = "px", .min = 1, .max = 16384, .doc = "Radius of the drop"})
      .add("wall_alignment", &Params::wall_alignment, WallAlignment::field_info())
      .check([](const Params& p) -> std::string {
        if (p.view_px.x != std::floor(p.view_px.x) || p.view_px.y != std::floor(p.view_px.y))
          return "view_px must be integers";
        return {};
      })
      .validity("The drop is round and two-dimensional, without depth.");
}

Drop::Drop(const Params& p, const ArenaContext& c)
    : p_(p), m_per_px_(c.scale.m_per_px), radius_(float(p.radius_px * c.scale.m_per_px)) {}

// Most agents do not touch a wall: one vectorised test per row of agents.
FABA_VECTORISED bool all_inside(const float* x, const float* y, std::size_t n, float r2_max) {
  std::uint32_t outside = 0;
  for (std::size_t i = 0; i < n; ++i) outside |= std::uint32_t(x[i] * x[i] + y[i] * y[i] > r2_max);
  return outside == 0;
}

void Drop::confine(State& s, const StepContext& c) const {
  const WallAlignment wall(s, p_.wall_alignment, c.dt);
  const float r2_max = radius_ * radius_;
  constexpr float kInside = 1.0f - 4e-7f;  // a few ulp, so that rounding cannot put a cell outside
  for (std::size_t row = c.begin; row < c.end; row += kArenaRow) {
    const std::size_t end = std::min(row + kArenaRow, c.end);
    if (all_inside(&c.to_x[row], &c.to_y[row], end - row, r2_max)) continue;
    for (std::size_t i = row; i < end; ++i) {
      const float x = c.to_x[i], y = c.to_y[i], r2 = x * x + y * y;
      if (r2 <= r2_max) continue;
      const float r = std::sqrt(r2), back = radius_ * kInside / r;
      wall.touch(i, x / r, y / r);
      c.to_x[i] = x * back;  // removes only the outward component of the move: the cell slides
      c.to_y[i] = y * back;
    }
  }
}

double Drop::depth(Vec2 p) const { return double(radius_) - norm(p); }

// Cells that swim along `direction` keep their distance `across` from the axis of the drop in that direction,
// and stop at the edge.
Vec2 Drop::wall_point(double direction, double across, double depth) const {
  const auto d = portable::sincos(direction);
  const double forward = std::sqrt(std::max(0.0, 1 - across * across)), r = double(radius_) - depth;
  return {r * (forward * d.cos - across * d.sin), r * (forward * d.sin + across * d.cos)};
}

Grid Drop::grid() const {
  const int half = int(std::ceil(p_.radius_px)) + 1, n = 2 * half + 1;
  return {n, n, float(m_per_px_), float(-(half + 0.5) * m_per_px_), float(-(half + 0.5) * m_per_px_)};
}

Frame Drop::frame() const { return {m_per_px_, int(p_.view_px.x), int(p_.view_px.y), p_.centre_px}; }

}  // namespace

void add_drop(ArenaRegistry& r) { r.add<Drop>(); }

}  // namespace faba
