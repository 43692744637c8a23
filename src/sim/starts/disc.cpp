#include "core/portable_math.h"
#include "sim/start.h"

namespace faba {
namespace {

/// Uniform in a disc.
class StartDisc final : public Start {
 public:
  struct Params {
    std::optional<Vec2> centre_px;
    double radius_px = 50;
  };
  static Schema<Params> schema();
  StartDisc(const Params& p, const StartContext& c) : radius_(p.radius_px * c.arena->frame().m_per_px) {
    if (p.centre_px) centre_ = c.arena->frame().world_from_image(*p.centre_px);
  }
  std::optional<Vec2> place(const PlaceDraw& d) const override {
    const auto& u = d.u;
    const auto a = portable::sincos(2 * portable::kPi * u[1]);
    return centre_ + (radius_ * std::sqrt(u[0])) * Vec2{a.cos, a.sin};
  }

 private:
  Vec2 centre_;    ///< m, world
  double radius_;  ///< m
};

Schema<StartDisc::Params> StartDisc::schema() {
  return Schema<Params>("disc", "Uniform in a disc")
      .add("centre_px", &Params::centre_px,
           {.unit = "px",
            .min = -1e5,
            .max = 1e5,
            .doc = "Centre in the image, y down; default: the centre of the arena"})
      .add("radius_px", &Params::radius_px, {.unit = "px", .min = 0, .max = 1e5, .doc = "Radius"});
}

}  // namespace

void add_start_disc(StartRegistry& r) { r.add<StartDisc>(); }

}  // namespace faba
