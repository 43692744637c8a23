#include <cmath>

#include "control/plant/linear_design.h"
#include "control/plant/steering.h"

namespace faba {
namespace {

/// Linear-quadratic regulator (theory F3), designed from the plant of the swarm's mean,
///   a = sat(-(k_p e + k_v v + k_i integral of e)),   |a| <= 1,
/// a fraction of `max_output` along which the cells swim. The gains minimise the sum over the frames of
/// (|e| / error)^2 + |a|^2 for a swarm whose velocity is small. Without an estimator that predicts, the
/// position at the time of the command follows from the commands since the picture. The ambient field is
/// compensated.
class Lqr final : public Controller {
 public:
  struct Params {
    double max_output = 5;
    double error_px = 2;
    std::optional<double> velocity_weight, integral_time;
    MotionParams motion;
  };
  static constexpr std::array kTraits = {Trait::feedback};
  static Schema<Params> schema();
  Lqr(const Params& p, const ControlContext& c);
  Command update(const Estimate& e, const Target& target, double dt) override;
  double max_field() const override { return steering_.max_field(); }
  const LqrDesign* design() const override { return &design_; }
  void archive(Archive& a) override { a& steering_& integral_; }

 private:
  Steering steering_;
  LqrDesign design_;
  Vec2 integral_;  ///< m s
};

Schema<Lqr::Params> Lqr::schema() {
  return Schema<Params>("lqr", "Linear-quadratic regulator, designed from the plant of the swarm")
      .add("max_output", &Params::max_output,
           {.min = 1e-3, .max = 1000, .doc = "Largest command in field units", .source = "thesis: 5"})
      .add("error_px", &Params::error_px,
           {.unit = "px",
            .min = 1e-3,
            .max = 1e5,
            .doc = "Distance from the setpoint that is worth the largest command: smaller is faster",
            .source = "assumed",
            .tuned = {0.2, 50},
            .title = "Distance worth the full command"})
      .add("velocity_weight", &Params::velocity_weight,
           {.unit = "m/s",
            .min = 1e-8,
            .max = 1,
            .doc = "Velocity that is worth the largest command; default: the velocity costs nothing"})
      .add("integral_time", &Params::integral_time,
           {.unit = "s",
            .min = 1e-3,
            .max = 1e6,
            .doc =
                "Time in which the distance error_px that remains is worth the largest command; removes the "
                "error of a steady flow; default: no integral"})
      .include(&Params::motion, MotionParams::schema())
      .validity(
          "The gains are optimal for small distances and a small velocity. A command is weaker near the "
          "setpoint, where a swarm whose speed does not depend on the field turns more slowly instead.");
}

Lqr::Lqr(const Params& p, const ControlContext& c)
    : steering_(p.motion, p.max_output, c),
      design_(lqr_design(linear_plant(steering_.plant(), steering_.strongest()), c.frame_period,
                         {p.error_px * c.scale.m_per_px, p.velocity_weight, p.integral_time})) {}

Command Lqr::update(const Estimate& e, const Target& target, double dt) {
  const MeanState s = steering_.at_command(e);
  const Vec2 error = s.position - target.position;
  if (!(e.visible > 0) || !std::isfinite(norm(error)) || !std::isfinite(norm(s.velocity)))
    return steering_.none();
  const Vec2 a =
      -1.0 * (design_.position * error + design_.velocity * s.velocity + design_.integral * integral_);
  if (norm(a) <= 1) integral_ = integral_ + dt * error;  // not while the command is saturated
  return steering_.command(e, a);
}

}  // namespace

void add_lqr(ControllerRegistry& r) { r.add<Lqr>(); }

}  // namespace faba
