#include <algorithm>
#include <cmath>

#include "control/trap.h"
#include "core/schema.h"

namespace faba {
namespace {

/// As `gradient`, with an outer proportional-integral loop that moves the zero until the swarm instead of the
/// zero is at the setpoint (theory F3). It removes the offset B_E / g of an unknown field.
///   zero = setpoint + gain e + integral of gain e dt / integral_time,  e = setpoint - swarm
class GradientFeedback final : public Controller {
 public:
  struct Params {
    double gain = 0.5;
    double integral_time = 3;
    double max_lead_px = 2000;
    Trap::Params trap;
  };
  static constexpr std::array kTraits = {Trait::feedback, Trait::seeks_null};
  static Schema<Params> schema() {
    return Schema<Params>("gradient_feedback",
                          "A zero of the field, displaced by feedback until the swarm is at the setpoint")
        .add("gain", &Params::gain,
             {.min = 0,
              .max = 10,
              .doc = "Displacement of the zero from the setpoint, as a fraction of the error of the swarm",
              .source = "assumed",
              .tuned = {0.05, 5}})
        .add("integral_time", &Params::integral_time,
             {.unit = "s",
              .min = 1e-2,
              .max = 1e6,
              .doc = "Integral time: with a constant error, the integral part grows by the proportional part "
                     "in each integral time",
              .source = "assumed",
              .tuned = {0.3, 30}})
        .add("most_px", &Params::max_lead_px,
             {.unit = "px",
              .min = 0,
              .max = 1e5,
              .doc = "Maximum distance of the zero from the setpoint",
              .title = "Maximum displacement of the zero"})
        .include(&Params::trap, Trap::Params::schema())
        .validity(
            "The response is limited by the relaxation of the swarm in the trap, which takes about the width "
            "of the swarm over the swimming speed.");
  }
  GradientFeedback(const Params& p, const ControlContext& c)
      : p_(p), m_per_px_(c.scale.m_per_px), trap_(p.trap, c) {}

  Command update(const Estimate& e, const Target& target, double dt) override {
    const Vec2 error = target.position - e.centroid;
    if (e.visible > 0 && std::isfinite(norm(error))) {
      lead_ = clipped(p_.gain * error + integral_);
      // Anti-windup: the integral stops growing when the displacement is at its limit.
      if (norm(lead_) < max_lead())
        integral_ = clipped(integral_ + (p_.gain * dt / p_.integral_time) * error);
    }
    return trap_.at(target.position + lead_);
  }
  std::vector<Vec2> nulls(std::span<const Vec2> setpoints) const override {
    return {setpoints.begin(), setpoints.end()};
  }
  void archive(Archive& a) override {
    a& lead_& integral_;
    trap_.archive(a);
  }

 private:
  double max_lead() const { return p_.max_lead_px * m_per_px_; }
  Vec2 clipped(Vec2 v) const { return norm(v) > max_lead() ? (max_lead() / norm(v)) * v : v; }

  Params p_;
  double m_per_px_;
  Trap trap_;
  Vec2 lead_, integral_;  ///< m
};

}  // namespace

void add_gradient_feedback(ControllerRegistry& r) { r.add<GradientFeedback>(); }

}  // namespace faba
