#include "core/portable_math.h"
#include "sim/start.h"

namespace faba {
namespace {

/// Piled up at the wall, as a swarm is after swimming along `direction` for long (theory A14, A21): uniform
/// across that direction, exponential in depth.
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
  // From the arena's centre to the middle of the view: there lies the part of the edge that a camera shows.
  // Left when the view is centred.
  double towards_view() const {
    const Vec2 middle = frame_.world_from_image({(frame_.width - 1) / 2.0, (frame_.height - 1) / 2.0});
    constexpr double kCentred = 0.1;  // of the view's width
    return norm(middle) < kCentred * frame_.width * frame_.m_per_px ? portable::kPi
                                                                    : portable::atan2(middle.y, middle.x);
  }

  Params p_;
  const Arena* arena_;
  Frame frame_;
  double direction_;  ///< rad
};

Schema<StartEdge::Params> StartEdge::schema() {
  return Schema<Params>("edge", "Piled up at the wall, as after swimming in one direction for long")
      .add("direction", &Params::direction,
           {.unit = "rad",
            .min = -10,
            .max = 10,
            .doc = "Direction towards that wall, world frame: \"0 deg\" right, \"90 deg\" up; when absent "
                   "towards "
                   "the part of the edge in view, or left"})
      .add("depth_px", &Params::depth_px,
           {.unit = "px", .min = 0, .max = 1e4, .doc = "Mean depth of the pile", .source = "assumed (A21)"})
      .add("visible", &Params::visible, {.doc = "Only where the camera sees it"});
}

}  // namespace

void add_start_edge(StartRegistry& r) { r.add<StartEdge>(); }

}  // namespace faba
