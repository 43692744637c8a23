#include <algorithm>
#include <cmath>
#include <limits>

#include "control/plant/linear_design.h"
#include "control/plant/steering.h"
#include "control/trap.h"
#include "core/portable_math.h"

namespace faba {
namespace {

/// Mean and variance (theory F3): gathers the swarm until its RMS radius is below `compact_px`, then moves it
/// to the setpoint, and gathers it again when the radius exceeds `spread_px`.
/// - Gathering at the edge: a uniform field in one direction; the cells slide along the edge to the point
/// that lies in
///   this direction. In a trap: a zero of the field at the swarm.
/// - Transport by the field: the regulator `lqr` on the mean. By the trap: the zero moves to the setpoint,
/// and waits while
///   the swarm is wider than `spread_px`.
class Compact final : public Controller {
 public:
  enum class Gathering { edge, trap };
  enum class Transport { field, trap };
  struct Params {
    Gathering gather = Gathering::edge;
    Transport transport = Transport::field;
    double compact_px = 80, spread_px = 200;
    double patience = 3;
    std::optional<double> direction;
    double speed_fraction = 0.2;
    double max_output = 5;
    double error_px = 2;
    MotionParams motion;
  };
  static constexpr std::array kTraits = {Trait::feedback};
  static Schema<Params> schema();
  Compact(const Params& p, const ControlContext& c);
  Command update(const Estimate& e, const Target& target, double dt) override;
  double max_field() const override;
  void archive(Archive& a) override {
    a& steering_& transporting_& started_& along_& zero_& smallest_& waited_;
    trap_.archive(a);
  }

 private:
  void begin_gathering(const Estimate& e, Vec2 target);
  bool gathered(double radius, double dt);
  Command transport(const Estimate& e, Vec2 target, double radius, double dt);
  Vec2 edge_towards(Vec2 target, Vec2 swarm) const;

  Params p_;
  ControlContext c_;
  Steering steering_;
  LqrDesign design_;
  Trap trap_;
  bool transporting_ = false, started_ = false;
  Vec2 along_;           ///< direction of the edge at which the swarm is gathered
  Vec2 zero_;            ///< m, where the zero of the field is
  double smallest_ = 0;  ///< m, RMS radius since the gathering began
  double waited_ = 0;    ///< s since the radius decreased by more than 1 %
};

Schema<Compact::Params> Compact::schema() {
  return Schema<Params>("compact",
                        "Gathers the swarm at the edge or in a trap, then moves it to the setpoint")
      .add("gather", &Params::gather,
           {.doc =
                "edge: a uniform field drives the cells to one point of the edge; trap: a zero of the field",
            .choices = {"edge", "trap"}})
      .add("transport", &Params::transport,
           {.doc = "field: a uniform field moves the mean; trap: the zero of the field moves",
            .choices = {"field", "trap"}})
      .add("compact_px", &Params::compact_px,
           {.unit = "px",
            .min = 0,
            .max = 1e5,
            .doc = "RMS radius below which the swarm is moved to the setpoint",
            .source = "assumed"})
      .add("spread_px", &Params::spread_px,
           {.unit = "px",
            .min = 0,
            .max = 1e5,
            .doc = "RMS radius above which the swarm is gathered again, or above which a moving trap waits",
            .source = "assumed"})
      .add("patience", &Params::patience,
           {.unit = "s",
            .min = 0.1,
            .max = 1e6,
            .doc = "Time without a decrease of the RMS radius by 1 %, after which the swarm is moved "
                   "although it is wider "
                   "than compact_px",
            .source = "assumed"})
      .add("direction", &Params::direction,
           {.unit = "rad",
            .min = -100,
            .max = 100,
            .doc = "Direction of the edge at which the swarm is gathered, counter-clockwise from x; default: "
                   "that of "
                   "the setpoint from the centre of the drop, or without a drop the nearest corner"})
      .add("speed_fraction", &Params::speed_fraction,
           {.min = 1e-3,
            .max = 0.9,
            .doc = "Speed of a moving trap, relative to the speed of the cells",
            .source = "assumed"})
      .add("max_output", &Params::max_output,
           {.min = 1e-3, .max = 1000, .doc = "Largest command in field units", .source = "thesis: 5"})
      .add("error_px", &Params::error_px,
           {.unit = "px",
            .min = 1e-3,
            .max = 1e5,
            .doc =
                "Distance from the setpoint that is worth the largest command, in the transport by the field",
            .source = "assumed",
            .title = "Distance worth the full command"})
      .include(&Params::motion, MotionParams::schema())
      .check([](const Params& p) -> std::string {
        return p.spread_px <= p.compact_px ? "spread_px must be larger than compact_px" : "";
      })
      .validity(
          "A uniform field without walls cannot make a swarm smaller (F1). The transport by the field "
          "spreads the swarm "
          "along the path by the differences in speed; two coils have no trap.");
}

Compact::Compact(const Params& p, const ControlContext& c)
    : p_(p),
      c_(c),
      steering_(p.motion, p.max_output, c),
      design_(lqr_design(linear_plant(steering_.plant(), steering_.strongest()), c.frame_period,
                         {p.error_px * c.scale.m_per_px, {}, {}})),
      trap_({}, c) {}

double Compact::max_field() const {
  const bool traps = p_.gather == Gathering::trap || p_.transport == Transport::trap;
  return traps ? std::numeric_limits<double>::infinity() : steering_.max_field();
}

Vec2 Compact::edge_towards(Vec2 target, Vec2 swarm) const {
  if (p_.direction) {
    const auto turn = portable::sincos(*p_.direction);
    return {turn.cos, turn.sin};
  }
  const Vec2 centre = c_.drop ? c_.drop->centre : Vec2{};
  Vec2 to = target - centre;
  if (!(norm(to) > c_.scale.m_per_px)) to = swarm - centre;  // a setpoint at the centre has no nearest edge
  if (!c_.drop) to = {to.x < 0 ? -1.0 : 1.0, to.y < 0 ? -1.0 : 1.0};
  const double size = norm(to);
  return size > 0 ? (1 / size) * to : Vec2{1, 0};
}

void Compact::begin_gathering(const Estimate& e, Vec2 target) {
  transporting_ = false;
  started_ = true;
  along_ = edge_towards(target, e.centroid);
  // A trap in the middle reaches the cells on all sides.
  zero_ = c_.drop ? c_.drop->centre : e.centroid;
  smallest_ = std::numeric_limits<double>::max();
  waited_ = 0;
}

// Whether the swarm is as compact as it gets. Cells that exclude each other fill a part of the edge.
bool Compact::gathered(double radius, double dt) {
  if (radius < 0.99 * smallest_) {
    smallest_ = radius;
    waited_ = 0;
  } else {
    waited_ += dt;
  }
  return radius <= p_.compact_px * c_.scale.m_per_px || waited_ >= p_.patience;
}

Command Compact::transport(const Estimate& e, Vec2 target, double radius, double dt) {
  if (p_.transport == Transport::field) {
    const MeanState s = steering_.at_command(e);
    const Vec2 error = s.position - target;
    if (!std::isfinite(norm(error)) || !std::isfinite(norm(s.velocity))) return steering_.none();
    return steering_.command(e, -1.0 * (design_.position * error + design_.velocity * s.velocity));
  }
  const Vec2 to = target - zero_;
  const double step = p_.speed_fraction * steering_.plant().speed * dt;
  if (radius <= p_.spread_px * c_.scale.m_per_px)
    zero_ = norm(to) <= step ? target : zero_ + (step / norm(to)) * to;
  return trap_.at(zero_);
}

Command Compact::update(const Estimate& e, const Target& target, double dt) {
  const double radius = std::sqrt(e.cov.xx + e.cov.yy);
  if (!(e.visible > 0) || !std::isfinite(norm(e.centroid)) || !std::isfinite(norm(target.position)) ||
      !std::isfinite(radius))
    return steering_.none();
  const bool too_wide = p_.transport == Transport::field && radius > p_.spread_px * c_.scale.m_per_px;
  if (!started_ || (transporting_ && too_wide)) begin_gathering(e, target.position);
  if (!transporting_ && gathered(radius, dt)) {
    transporting_ = true;
    if (p_.gather == Gathering::edge) zero_ = e.centroid;
  }
  if (transporting_) return transport(e, target.position, radius, dt);
  return p_.gather == Gathering::trap ? trap_.at(zero_) : steering_.command(e, along_);
}

}  // namespace

void add_compact(ControllerRegistry& r) { r.add<Compact>(); }

}  // namespace faba
