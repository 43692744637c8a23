#include <algorithm>
#include <cmath>

#include "control/controller.h"
#include "control/duty.h"
#include "core/schema.h"

namespace faba {
namespace {

/// Proportional-integral law on the vector error (theory F3), delay-aware:
///   u = sat(k_p e + k_i integral e),  k_p = gain / (hold + delay) per frame,
/// u is the desired drift in px per frame. Gain 0.45 is the largest that stays well damped for an integrator
/// plant with that delay. The drift is actuated in one of two modes:
/// - `magnitude`: by the field strength, one field unit per px/iteration (Basic);
/// - `duty`: full strength along the desired direction in a fraction of the frames and against it in the
///   others, so that the mean is the desired drift: for cells whose swimming speed does not depend on the
///   field strength (dipole, Adapted; F1 d).
/// `lead` compensates reorientation that takes longer than a frame: e is computed from the centroid
/// extrapolated with its present velocity (derivative action on the measurement; F3).
/// Anti-windup: the integral does not grow while the command is saturated.
class Proportional final : public Controller {
 public:
  enum class Actuation { magnitude, duty };
  struct Params {
    double gain = 0.45;
    double integral_gain = 0;
    double max_output = 5;
    double dead_zone_px = 0;
    std::optional<int> delay_frames;
    int hold_frames = 2;
    Actuation actuation = Actuation::magnitude;
    double speed = 186e-6;
    std::optional<double> lead;
  };
  static constexpr std::array kTraits = {Trait::feedback};
  static Schema<Params> schema();
  Proportional(const Params& p, const ControlContext& c);
  Command update(const Estimate& e, const Target& target, double dt) override;
  double max_field() const override { return p_.gain > 0 ? p_.max_output * c_.scale.field_unit : 0; }
  void archive(Archive& a) override { a& integral_& duty_& last_& has_last_; }

 private:
  Params p_;
  ControlContext c_;
  double k_p_ = 0;  ///< drift per error, 1/frame
  Vec2 integral_;   ///< px frames
  Duty duty_;
  double horizon_ = 0;     ///< extrapolation time of the centroid, s
  Vec2 last_;              ///< centroid of the previous update, m
  bool has_last_ = false;  ///< last_ is valid
};

Schema<Proportional::Params> Proportional::schema() {
  return Schema<Params>("proportional",
                        "Proportional-integral law with a gain that follows from the camera delay")
      .add("gain", &Params::gain,
           {.min = 0,
            .max = 10,
            .doc = "Loop gain; the proportional gain is gain / (hold_frames + delay)",
            .source = "0.45: theory F3",
            .tuned = {0.05, 5}})
      .add("integral_gain", &Params::integral_gain,
           {.min = 0,
            .max = 10,
            .doc = "Integral gain per frame, relative to the proportional gain; compensates steady drift"})
      .add("max_output", &Params::max_output,
           {.min = 0, .max = 1000, .doc = "Maximum command in field units"})
      .add("dead_zone_px", &Params::dead_zone_px,
           {.unit = "px", .min = 0, .max = 1e4, .doc = "No command within this distance of the setpoint"})
      .add("delay_frames", &Params::delay_frames,
           {.min = 0, .max = 1000, .doc = "Design delay in frames; default: that of the camera"})
      .add("hold_frames", &Params::hold_frames,
           {.min = 1,
            .max = 100,
            .doc = "Frames for which a cell keeps its velocity",
            .source = "A3: 2",
            .title = "Frames per cell velocity"})
      .add("actuation", &Params::actuation,
           {.doc = "Method to reduce the drift velocity. magnitude: a weaker field; duty: full field, "
                   "reversed in a fraction of the frames",
            .choices = {"magnitude", "duty"}})
      .add("speed", &Params::speed,
           {.unit = "m/s",
            .min = 1e-7,
            .max = 1e-2,
            .doc = "duty: swimming speed of the cells",
            .source = "thesis: 186 um/s"})
      .add("lead", &Params::lead,
           {.unit = "s",
            .min = 0,
            .max = 10,
            .doc = "Time by which the position is predicted in addition to the delay, about the time that "
                   "cells need "
                   "to turn; default: no prediction",
            .source = "theory F2: ln(2 kappa) / w_B",
            .tuned = {0.01, 1},
            .title = "Prediction time"})
      .validity(
          "The law is linear, for an integrator plant. Reorientation that takes longer than a frame adds a "
          "delay that is compensated only with `lead`.");
}

Proportional::Proportional(const Params& p, const ControlContext& c) : p_(p), c_(c) {
  const double delay = p.delay_frames ? double(*p.delay_frames) : c.delay_frames;
  k_p_ = p.gain / (p.hold_frames + delay);
  if (p.lead) horizon_ = *p.lead + delay * c.frame_period;
}

Command Proportional::update(const Estimate& e, const Target& target, double dt) {
  const Vec2 moved = has_last_ && dt > 0 ? (horizon_ / dt) * (e.centroid - last_) : Vec2{};
  has_last_ = e.visible > 0 && std::isfinite(norm(e.centroid));
  last_ = e.centroid;
  const Vec2 error_px = (1 / c_.scale.m_per_px) * (target.position - e.centroid - moved);
  const double distance = norm(error_px);  // not finite: no target or overflow
  if (!has_last_ || !std::isfinite(distance) || distance <= p_.dead_zone_px)
    return field_command(c_, e.centroid, {});

  const bool duty = p_.actuation == Actuation::duty;
  // Largest drift of the plant, px per frame
  const double max_drift = duty ? p_.speed * c_.frame_period / c_.scale.m_per_px
                                : p_.max_output * c_.frame_period / c_.scale.iteration;
  const Vec2 summed = integral_ + error_px;
  const Vec2 wanted = k_p_ * (error_px + p_.integral_gain * summed);
  const double size = norm(wanted);
  if (size <= max_drift) integral_ = summed;
  if (size == 0) return field_command(c_, e.centroid, {});
  const Vec2 along = (1 / size) * wanted;
  const double fraction = std::min(size / max_drift, 1.0);
  if (!duty) return field_command(c_, e.centroid, (fraction * p_.max_output) * along);

  return field_command(c_, e.centroid, (duty_.sign(fraction) * p_.max_output) * along);
}

}  // namespace

void add_proportional(ControllerRegistry& r) { r.add<Proportional>(); }

}  // namespace faba
