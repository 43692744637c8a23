#include <fmt/format.h>

#include <cmath>

#include "control/plant/motion_model.h"
#include "control/plant/rotation.h"
#include "control/plant/steering.h"
#include "core/portable_math.h"

namespace faba {
namespace {

/// Holds a swarm by a rotating field and moves it slowly by a constant bias (theory F3, B3.6 to B3.8). Cells
/// swim in circles of radius v / Omega; with phi* = arcsin(Omega / w_B) the centres drift by
///   u = (v / 2) B_dc / B_rot, turned by phi*,   u = sat(k (setpoint - centre)),  |B_dc| <= 0.3 B_rot.
/// The centre is the centroid less the circle of the known headings. Unlike a mean over a revolution this
/// has no delay; an error of it rotates with the field, and changes its magnitude instead of the drift.
/// Assumed: all cells are locked to the field. The ambient field is compensated.
class RotatingHold final : public Controller {
 public:
  struct Params {
    RotationParams rotation;
    MotionParams motion;
  };
  static constexpr std::array kTraits = {Trait::feedback};
  static Schema<Params> schema();
  RotatingHold(const Params& p, const ControlContext& c);
  Command update(const Estimate& e, const Target& target, double dt) override;
  double max_field() const override { return steering_.max_field(); }
  void archive(Archive& a) override { a& rotation_; }
  std::vector<std::string> notes(std::span<const Vec2> setpoints) const override;

 private:
  Rotation rotation_;
  CirclingSwarm swarm_;
  Steering steering_;
  double delay_;     ///< s, of an estimate that is not predicted
  double m_per_px_;  ///< m
};

constexpr double kHoldStrength = 1e-3;  // T

Schema<RotatingHold::Params> RotatingHold::schema() {
  return Schema<Params>("rotating_hold", "A rotating field holds the swarm, and a weak bias moves it slowly")
      .include(&Params::rotation, RotationParams::schema())
      .include(&Params::motion, MotionParams::schema())
      .validity(
          "The swarm moves with at most 15 % of its swimming speed. Cells that turn too slowly for the "
          "frequency are not held. The field holds the cells where they are and does not gather them.");
}

RotatingHold::RotatingHold(const Params& p, const ControlContext& c)
    : rotation_(p.rotation, kHoldStrength, p.motion.of(c.motion), c),
      swarm_(p.motion.of(c.motion), rotation_, p.rotation.gain, c),
      steering_(p.motion, (1 + Rotation::kLargestBias) * rotation_.strength() / c.scale.field_unit, c),
      delay_(c.delay_frames * c.frame_period),
      m_per_px_(c.scale.m_per_px) {}

std::vector<std::string> RotatingHold::notes(std::span<const Vec2> setpoints) const {
  constexpr double kWide = 10;  // px, the smallest settling band (theory F5)
  const double radius = swarm_.speed() / std::fabs(rotation_.rate());
  std::vector<std::string> notes;
  if (!setpoints.empty() && radius > kWide * m_per_px_)
    notes.push_back(
        fmt::format("the held cells circle with a radius of {:.3g} px ({:.3g} um) at {:.3g} Hz, so that the "
                    "mean of the swarm stays that far from its setpoint; a higher controller.frequency makes "
                    "the circles smaller",
                    radius / m_per_px_, radius * 1e6, std::fabs(rotation_.rate()) / (2 * portable::kPi)));
  return notes;
}

Command RotatingHold::update(const Estimate& e, const Target& target, double dt) {
  if (!(e.visible > 0) || !std::isfinite(norm(e.centroid))) return steering_.none();
  rotation_.advance(dt);
  const Vec2 field = swarm_.hold(e.centroid, target.position, e.predicted ? 0 : delay_, rotation_);
  return steering_.linear(e.centroid, (1 / steering_.strongest()) * field);
}

}  // namespace

void add_rotating_hold(ControllerRegistry& r) { r.add<RotatingHold>(); }

}  // namespace faba
