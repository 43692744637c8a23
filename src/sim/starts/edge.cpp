#include "core/portable_math.h"
#include "sim/start.h"

namespace faba {
namespace {

/// Accumulated at the wall, as after a long time of swimming along `direction` (theory A14, A21): uniform
/// perpendicular to that direction, exponential in depth.
class StartEdge final : public Start {
 public:
  struct Params {
    std::optional<double> direction;
    double depth_px = 6;
    bool visible = false;
  };
  static Schema<Params> schema();
  StartEdge(const Params& p, const StartContext& c)
      : p_(p), arena_(c.arena), frame_(c.arena->frame()), direction_(p.direction.value_or(towards_view())) {}

  std::optional<Vec2> place(const PlaceDraw& d) const override {
    const auto& u = d.u;
    const double depth = -portable::log(u[1]) * p_.depth_px * frame_.m_per_px;
    const Vec2 at = arena_->wall_point(direction_, 2 * u[0] - 1, depth);
    if (p_.visible && !frame_.in_view(frame_.image_from_world(at))) return std::nullopt;
    return at;
  }

 private:
  // Direction from the centre of the arena to the centre of the view, which contains the visible part of the
  // edge. Left if the view is centred.
  double towards_view() const {
    const Vec2 middle = frame_.world_from_image({(frame_.width - 1) / 2.0, (frame_.height - 1) / 2.0});
    constexpr double kCentred = 0.1;  // fraction of the view's width
    return norm(middle) < kCentred * frame_.width * frame_.m_per_px ? portable::kPi
                                                                    : portable::atan2(middle.y, middle.x);
  }

  Params p_;
  const Arena* arena_;
  Frame frame_;
  double direction_;  ///< rad
};

Schema<StartEdge::Params> StartEdge::schema() {
  return Schema<Params>("edge", "Accumulated at the wall, as after a long time of swimming in one direction")
      .add("direction", &Params::direction,
           {.unit = "rad",
            .min = -10,
            .max = 10,
            .doc = "Direction towards the wall, world frame: \"0 deg\" right, \"90 deg\" up; default: "
                   "towards the visible part of the edge, or left"})
      .add("depth_px", &Params::depth_px,
           {.unit = "px",
            .min = 0,
            .max = 1e4,
            .doc = "Mean distance from the wall",
            .source = "assumed (A21)"})
      .add("visible", &Params::visible, {.doc = "Only positions in view"});
}

}  // namespace

void add_start_edge(StartRegistry& r) { r.add<StartEdge>(); }

}  // namespace faba
