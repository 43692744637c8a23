#include <algorithm>
#include <cmath>

#include "core/portable_math.h"
#include "core/schema.h"
#include "core/vectorised.h"
#include "sim/arena.h"
#include "sim/arenas/wall.h"

namespace faba {
namespace {

/// The constrained simulation of the thesis (theory A12): a closed rectangle, completely in view. Limits
/// apply to the centres of the border pixels (A2): `clamp` sets each coordinate to the border, `reflect`
/// mirrors it, `reject` undoes the complete move.
class Box final : public Arena {
 public:
  enum class Limits { clamp, reflect, reject };
  struct Params {
    Vec2 size_px{640, 480};
    Limits limits = Limits::clamp;
    double wall_alignment = 0;
  };
  static Schema<Params> schema();
  Box(const Params& p, const ArenaContext& c);

  void confine(State& s, const StepContext& c) const override;
  double depth(Vec2 p_world) const override;
  Vec2 wall_point(double direction, double across, double depth) const override;
  Grid grid() const override;
  Frame frame() const override;
  Outline outline() const override { return {frame().centre_image, 0}; }
  bool needs_exclusion() const override { return p_.limits == Limits::reject; }

 private:
  Params p_;
  double m_per_px_;
  float half_x_, half_y_;  ///< m, to the centres of the border pixels
};

Schema<Box::Params> Box::schema() {
  return Schema<Params>("box", "A closed rectangle, completely in view")
      .add("size_px", &Params::size_px,
           {.unit = "px", .min = 2, .max = 65536, .doc = "Width and height, integers"})
      .add("limits", &Params::limits,
           {.doc = "Treatment of a move across the border",
            .source = "clamp: the thesis's accumulation on edges (A2)",
            .choices = {"clamp", "reflect", "reject"}})
      .add("wall_alignment", &Params::wall_alignment, WallAlignment::field_info())
      .check([](const Params& p) -> std::string {
        if (p.size_px.x != std::floor(p.size_px.x) || p.size_px.y != std::floor(p.size_px.y))
          return "size_px must be integers";
        return {};
      })
      .validity("A real drop is round and larger than the view: use `drop` to compare with a video.");
}

Box::Box(const Params& p, const ArenaContext& c)
    : p_(p),
      m_per_px_(c.scale.m_per_px),
      half_x_(float((p.size_px.x - 1) / 2 * c.scale.m_per_px)),
      half_y_(float((p.size_px.y - 1) / 2 * c.scale.m_per_px)) {}

// Most agents do not touch a wall: one vectorised test per row of agents.
FABA_VECTORISED bool all_inside(const float* x, const float* y, std::size_t n, float half_x, float half_y) {
  std::uint32_t outside = 0;
  for (std::size_t i = 0; i < n; ++i)
    outside |= std::uint32_t(std::fabs(x[i]) > half_x) | std::uint32_t(std::fabs(y[i]) > half_y);
  return outside == 0;
}

FABA_VECTORISED void clamp(float* __restrict v, std::size_t n, float half) {
  for (std::size_t i = 0; i < n; ++i) {
    const float above = v[i] < -half ? -half : v[i];
    v[i] = above > half ? half : above;
  }
}

void Box::confine(State& s, const StepContext& c) const {
  if (p_.limits == Limits::clamp && p_.wall_alignment == 0) {  // contacts with the wall are not needed
    clamp(&c.to_x[c.begin], c.end - c.begin, half_x_);
    clamp(&c.to_y[c.begin], c.end - c.begin, half_y_);
    return;
  }
  const auto x = s.agents["x"], y = s.agents["y"];
  const WallAlignment wall(s, p_.wall_alignment, c.dt);
  for (std::size_t row = c.begin; row < c.end; row += kArenaRow) {
    const std::size_t end = std::min(row + kArenaRow, c.end);
    if (all_inside(&c.to_x[row], &c.to_y[row], end - row, half_x_, half_y_)) continue;
    for (std::size_t i = row; i < end; ++i) {
      const float px = c.to_x[i], py = c.to_y[i];
      if (std::fabs(px) <= half_x_ && std::fabs(py) <= half_y_) continue;
      if (std::fabs(px) > half_x_) wall.touch(i, std::copysign(1.0f, px), 0.0f);
      if (std::fabs(py) > half_y_) wall.touch(i, 0.0f, std::copysign(1.0f, py));
      float qx = std::clamp(px, -half_x_, half_x_), qy = std::clamp(py, -half_y_, half_y_);
      if (p_.limits == Limits::reflect) {  // a move longer than the box ends on its border
        qx = std::clamp(2 * qx - px, -half_x_, half_x_);
        qy = std::clamp(2 * qy - py, -half_y_, half_y_);
      } else if (p_.limits == Limits::reject) {
        qx = x[i];
        qy = y[i];
      }
      c.to_x[i] = qx;
      c.to_y[i] = qy;
    }
  }
}

double Box::depth(Vec2 p) const {
  return std::min(double(half_x_) - std::fabs(p.x), double(half_y_) - std::fabs(p.y));
}

Vec2 Box::wall_point(double direction, double across, double depth) const {
  const auto d = portable::sincos(direction);
  if (std::fabs(d.cos) >= std::fabs(d.sin))
    return {std::copysign(double(half_x_) - depth, d.cos), across * double(half_y_)};
  return {across * double(half_x_), std::copysign(double(half_y_) - depth, d.sin)};
}

Grid Box::grid() const {
  return {int(p_.size_px.x), int(p_.size_px.y), float(m_per_px_), float(-p_.size_px.x / 2 * m_per_px_),
          float(-p_.size_px.y / 2 * m_per_px_)};
}

Frame Box::frame() const {
  return {m_per_px_, int(p_.size_px.x), int(p_.size_px.y), {(p_.size_px.x - 1) / 2, (p_.size_px.y - 1) / 2}};
}

}  // namespace

void add_box(ArenaRegistry& r) { r.add<Box>(); }

}  // namespace faba
