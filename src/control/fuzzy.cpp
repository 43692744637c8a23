#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>

#include "control/controller.h"
#include "core/counted.h"
#include "core/schema.h"

namespace faba {
namespace {

/// The thesis's fuzzy controller (theory A9, eq. 3.2): zero-order Sugeno on the distance d to the
/// setpoint,
///   M = sum_k mu_k(d) M_k / sum_k mu_k(d),   mu(d; a, b, c, e) = clamp(min((d-a)/(b-a), 1, (e-d)/(e-c)), 0,
///   1),
/// and a field command of strength M towards the setpoint. Sets, rules and outputs are scenario data: each
/// `[[controller.set]]` adds one fuzzy state. Without sets, the two of the thesis are used: near -> max/2,
/// far -> max. The breakpoints 40 and 120 px are assumed: the thesis shows them in a figure only.
/// The published sets never command zero, so the swarm oscillates around its setpoint (rms 2.2 px with
/// Basic, more with a camera delay). A set `at` with output 0 prevents that, but sets cannot reduce
/// dispersion (F1).
class Fuzzy final : public Controller {
 public:
  /// One fuzzy state and its rule: corners of the trapezoid in px, output in field units.
  struct Set {
    std::string name;
    std::vector<double> trapezoid_px;
    double output = 0;
    static Schema<Set> schema();
  };
  enum class Direction { vector, axis_sign, per_axis };
  struct Params {
    double max_output = 5;
    double near_px = 40, far_px = 120;
    std::vector<Set> set;
    Direction direction = Direction::vector;
  };
  static constexpr std::array kTraits = {Trait::feedback};
  static Schema<Params> schema();
  Fuzzy(const Params& p, const ControlContext& c);
  Command update(const Estimate& e, const Target& target, double dt) override;
  double max_field() const override;

  /// Strength of the command in field units at a distance in px.
  double strength(double distance_px) const;

 private:
  Params p_;
  ControlContext c_;
};

constexpr double kFar = 1e9;  // px; where an open-ended trapezoid ends

// A vertical edge has no slope to divide by: membership at the corner itself is 1.
double membership(const std::vector<double>& t, double d) {
  const double up = t[1] > t[0] ? (d - t[0]) / (t[1] - t[0]) : d >= t[0] ? 1.0 : 0.0;
  const double down = t[3] > t[2] ? (t[3] - d) / (t[3] - t[2]) : d <= t[3] ? 1.0 : 0.0;
  return std::clamp(std::min({up, 1.0, down}), 0.0, 1.0);
}

double sign(double v) { return v > 0 ? 1.0 : v < 0 ? -1.0 : 0.0; }

Schema<Fuzzy::Set> Fuzzy::Set::schema() {
  return Schema<Set>("set", "A fuzzy state: a range of distances and its command")
      .add("name", &Set::name, {.doc = "Name of the state, such as \"near\""})
      .add("trapezoid_px", &Set::trapezoid_px,
           {.unit = "px",
            .min = -kFar,
            .max = kFar,
            .doc = "Four corners: membership increases from the first to the second and decreases from the "
                   "third to the fourth"})
      .add("output", &Set::output, {.min = 0, .max = 1000, .doc = "Command in field units"})
      .check([](const Set& s) -> std::string {
        if (s.trapezoid_px.size() != 4)
          return fmt::format("trapezoid_px has {}; it must have 4", counted(s.trapezoid_px.size(), "value"));
        if (!std::is_sorted(s.trapezoid_px.begin(), s.trapezoid_px.end()))
          return fmt::format("trapezoid_px = [{:g}]; the corners must be in ascending order",
                             fmt::join(s.trapezoid_px, ", "));
        return {};
      });
}

Schema<Fuzzy::Params> Fuzzy::schema() {
  return Schema<Params>("fuzzy",
                        "Fuzzy controller of the thesis: strength from distance, direction to the setpoint")
      .add("max_output", &Params::max_output,
           {.min = 0,
            .max = 1000,
            .doc = "Command far from the setpoint, in field units; half of it near the setpoint",
            .source = "thesis: 5"})
      .add("near_px", &Params::near_px,
           {.unit = "px",
            .min = 0,
            .max = 1e5,
            .doc = "Distance up to which the swarm is near",
            .source = "assumed (A9)",
            .tuned = {1, 100},
            .title = "Near distance"})
      .add("far_px", &Params::far_px,
           {.unit = "px",
            .min = 0,
            .max = 1e5,
            .doc = "Distance from which the swarm is far",
            .source = "assumed (A9)",
            .tuned = {5, 400},
            .title = "Far distance"})
      .add("set", &Params::set,
           {.doc = "Custom fuzzy states that replace near and far: [[controller.set]]",
            .title = "Fuzzy states"})
      .add("direction", &Params::direction,
           {.doc = "Direction of the command: vector: straight to the setpoint; axis-sign: sign of each "
                   "component; per-axis: one fuzzy law per axis",
            .source = "assumed vector: the rules of the thesis define a strength only (A9)",
            .choices = {"vector", "axis-sign", "per-axis"},
            .title = "Direction of the command"})
      .check([](const Params& p) -> std::string {
        if (p.near_px <= p.far_px) return {};
        return fmt::format("near_px = {:g} must not be larger than far_px = {:g}", p.near_px, p.far_px);
      })
      .validity("The published sets never command zero: the swarm oscillates around its setpoint.");
}

Fuzzy::Fuzzy(const Params& p, const ControlContext& c) : p_(p), c_(c) {
  if (p_.set.empty())
    p_.set = {{"near", {0, 0, p.near_px, p.far_px}, p.max_output / 2},
              {"far", {p.near_px, p.far_px, kFar, kFar}, p.max_output}};
}

double Fuzzy::strength(double d) const {
  double weight = 0, sum = 0;
  for (const Set& s : p_.set) {
    const double mu = membership(s.trapezoid_px, d);
    weight += mu;
    sum += mu * s.output;
  }
  return weight > 0 ? sum / weight : 0;  // no set covers this distance: no command
}

// The strength is a weighted mean of the outputs; with one law per axis the vector is up to sqrt(2) longer.
double Fuzzy::max_field() const {
  double most = 0;
  for (const Set& s : p_.set) most = std::max(most, s.output);
  return (p_.direction == Direction::vector ? 1 : std::sqrt(2.0)) * most * c_.scale.field_unit;
}

Command Fuzzy::update(const Estimate& e, const Target& target, double) {
  const Vec2 error = target.position - e.centroid;
  const double d = norm(error), px = 1 / c_.scale.m_per_px;
  Vec2 u;
  if (e.visible > 0 && d > 0 && std::isfinite(d)) switch (p_.direction) {
      case Direction::vector:
        u = (strength(d * px) / d) * error;
        break;
      case Direction::axis_sign:
        u = strength(d * px) * Vec2{sign(error.x), sign(error.y)};
        break;
      case Direction::per_axis:
        u = {strength(std::fabs(error.x) * px) * sign(error.x),
             strength(std::fabs(error.y) * px) * sign(error.y)};
        break;
    }
  return field_command(c_, e.centroid, u);
}

}  // namespace

void add_fuzzy(ControllerRegistry& r) { r.add<Fuzzy>(); }

}  // namespace faba
