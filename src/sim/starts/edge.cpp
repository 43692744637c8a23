#include "core/portable_math.h"
#include "sim/start.h"

namespace faba {
namespace {

/// Piled up at the wall, as a swarm is after swimming along `direction` for long (theory A14, A21):
/// uniform across that direction, exponential in depth.
class StartEdge final : public Start {
 public:
  struct Params {
    double direction = portable::kPi;
    double depth_px = 6;
  };
  static Schema<Params> schema();
  StartEdge(const Params& p, const StartContext& c) : p_(p), arena_(c.arena) {}
  Vec2 place(const std::array<double, 3>& u) const override {
    const double depth = -portable::log(u[1]) * p_.depth_px * arena_->frame().m_per_px;
    return arena_->wall_point(p_.direction, 2 * u[0] - 1, depth);
  }

 private:
  Params p_;
  const Arena* arena_;
};

Schema<StartEdge::Params> StartEdge::schema() {
  return Schema<Params>("edge", "Piled up at the wall, as after swimming in one direction for long")
      .add("direction", &Params::direction,
           {.unit = "rad",
            .min = -10,
            .max = 10,
            .doc =
                "Direction towards that wall, world frame: \"0 deg\" right, \"90 deg\" up, \"180 deg\" left"})
      .add("depth_px", &Params::depth_px,
           {.unit = "px", .min = 0, .max = 1e4, .doc = "Mean depth of the pile", .source = "assumed (A21)"});
}

}  // namespace

void add_start_edge(StartRegistry& r) { r.add<StartEdge>(); }

}  // namespace faba
