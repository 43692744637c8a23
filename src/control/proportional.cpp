#include <algorithm>
#include <cmath>

#include "control/controller.h"
#include "core/schema.h"

namespace faba {
namespace {

/// Proportional-integral law on the vector error (theory F3), delay-aware:
///   u = sat(k_p e + k_i integral e),  k_p = gain / (hold + delay) per frame,
/// u in frames^-1 times px is the wanted drift in px per frame; gain 0.45 is the largest that stays well
/// damped for an integrator plant with that delay. How the drift is had depends on the cells:
/// - `magnitude`: the field's strength, one field unit per px/iteration (Basic);
/// - `duty`: full strength along the wanted direction for a part of the frames and against it for the rest,
/// so that the
///   mean is the wanted drift: for cells that swim at their own speed whatever the strength (dipole, Adapted;
///   F1 d).
/// `lead` adds what a turn that is longer than a frame needs: e is that of the centroid so much later, at its
/// present velocity (a derivative on the measurement; F3).
/// Anti-windup by back-calculation: the integral does not grow while the command is saturated.
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
  void archive(Archive& a) override { a& integral_& owed_& last_& seen_; }

 private:
  Params p_;
  ControlContext c_;
  double k_p_ = 0;      ///< px per frame of drift for each px of error
  Vec2 integral_;       ///< px frames
  double owed_ = 0;     ///< duty not yet given, in frames at full speed
  double horizon_ = 0;  ///< s that the centroid is predicted ahead
  Vec2 last_;           ///< centroid of the update before, m
  bool seen_ = false;   ///< there is such a centroid
};

Schema<Proportional::Params> Proportional::schema() {
  return Schema<Params>("proportional", "Proportional-integral law with a gain that knows the camera's delay")
      .add("gain", &Params::gain,
           {.min = 0,
            .max = 10,
            .doc = "Loop gain; the proportional gain is gain / (hold_frames + delay)",
            .source = "0.45: theory F3"})
      .add("integral_gain", &Params::integral_gain,
           {.min = 0,
            .max = 10,
            .doc = "Integral gain per frame, relative to the proportional one; against steady drifts"})
      .add("max_output", &Params::max_output,
           {.min = 0, .max = 1000, .doc = "Largest command in field units"})
      .add("dead_zone_px", &Params::dead_zone_px,
           {.unit = "px", .min = 0, .max = 1e4, .doc = "No command within this distance of the setpoint"})
      .add("delay_frames", &Params::delay_frames,
           {.min = 0, .max = 1000, .doc = "Delay to design for, in frames; the camera's own when absent"})
      .add("hold_frames", &Params::hold_frames,
           {.min = 1,
            .max = 100,
            .doc = "Frames for which the cells keep a velocity once drawn",
            .source = "A3: 2"})
      .add("actuation", &Params::actuation,
           {.doc = "How a slower drift is commanded: a weaker field, or full field for part of the time",
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
            .doc =
                "Steers where the swarm will be, at its present velocity, after the delay and so much more: "
                "the time in which cells turn; where it is when absent",
            .source = "theory F2: ln(2 kappa) / w_B"})
      .validity(
          "A linear law for an integrator plant: turning that takes longer than a frame adds delay it does "
          "not know, unless `lead` tells it.");
}

Proportional::Proportional(const Params& p, const ControlContext& c) : p_(p), c_(c) {
  const double delay = p.delay_frames ? double(*p.delay_frames) : c.delay_frames;
  k_p_ = p.gain / (p.hold_frames + delay);
  if (p.lead) horizon_ = *p.lead + delay * c.frame_period;
}

Command Proportional::update(const Estimate& e, const Target& target, double dt) {
  const Vec2 moved = seen_ && dt > 0 ? (horizon_ / dt) * (e.centroid - last_) : Vec2{};
  seen_ = e.visible > 0 && std::isfinite(norm(e.centroid));
  last_ = e.centroid;
  const Vec2 error_px = (1 / c_.scale.m_per_px) * (target.position - e.centroid - moved);
  const double distance = norm(error_px);  // not finite: no target, or one out of all reason
  if (!seen_ || !std::isfinite(distance) || distance <= p_.dead_zone_px)
    return drive_command(c_, e.centroid, {});

  const bool duty = p_.actuation == Actuation::duty;
  // px per frame that the plant can do at most, and per field unit
  const double most = duty ? p_.speed * c_.frame_period / c_.scale.m_per_px
                           : p_.max_output * c_.frame_period / c_.scale.iteration;
  const Vec2 summed = integral_ + error_px;
  const Vec2 wanted = k_p_ * (error_px + p_.integral_gain * summed);
  const double size = norm(wanted);
  if (size <= most) integral_ = summed;
  if (size == 0) return drive_command(c_, e.centroid, {});
  const Vec2 along = (1 / size) * wanted;
  const double fraction = std::min(size / most, 1.0);
  if (!duty) return drive_command(c_, e.centroid, (fraction * p_.max_output) * along);

  // Sigma-delta: forwards while drift is owed, else backwards, so that the mean over frames is the wanted
  // fraction.
  owed_ = std::clamp(owed_ + fraction, -2.0, 2.0);
  const double sign = owed_ >= 0 ? 1 : -1;
  owed_ -= sign;
  return drive_command(c_, e.centroid, (sign * p_.max_output) * along);
}

}  // namespace

void add_proportional(ControllerRegistry& r) { r.add<Proportional>(); }

}  // namespace faba
