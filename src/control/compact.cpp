#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>

#include "control/plant/rotation.h"
#include "control/plant/steering.h"
#include "control/trap.h"
#include "core/portable_math.h"

namespace faba {
namespace {

constexpr double kRotatingStrength = 1e-3;  // T

/// Mean and variance (theory F3): gathers the swarm until its RMS radius is below `compact_px`, then moves it
/// to the setpoint, and gathers it again when the radius exceeds `spread_px`.
/// - Gathering at the edge: a uniform field in one direction; the cells slide along the edge to the point
///   that lies in this direction. In a trap: a zero of the field in the middle of the drop.
/// - Transport by the field: the cells swim straight to the setpoint and are held there by a rotating field,
///   because they would disperse in a weak field (F1). By the trap: the zero moves to the setpoint, and waits
///   while the swarm is wider than `spread_px`.
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
    RotationParams rotation;
    MotionParams motion;
  };
  static constexpr std::array kTraits = {Trait::feedback};
  static Schema<Params> schema();
  Compact(const Params& p, const ControlContext& c);
  Command update(const Estimate& e, const Target& target, double dt) override;
  double max_field() const override;
  std::vector<Vec2> nulls(std::span<const Vec2> setpoints) const override;
  void archive(Archive& a) override {
    a& steering_& transporting_& holding_& started_& along_& zero_& smallest_& waited_;
    trap_.archive(a);
    if (rotation_) a&* rotation_;
  }

 private:
  void begin_gathering(const Estimate& e, Vec2 target);
  bool gathered(double radius, double dt);
  Command swim(const Estimate& e, Vec2 target, double dt);
  Command transport(const Estimate& e, Vec2 target, double radius, double dt);
  Vec2 edge_towards(Vec2 target, Vec2 swarm) const;

  Params p_;
  ControlContext c_;
  Steering steering_;
  std::optional<Rotation> rotation_;  ///< of the hold, with a transport by the field
  std::optional<CirclingSwarm> circling_;
  Trap trap_;
  bool transporting_ = false, holding_ = false, started_ = false;
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
                   "although it is wider than compact_px",
            .source = "assumed"})
      .add("direction", &Params::direction,
           {.unit = "rad",
            .min = -100,
            .max = 100,
            .doc = "Direction of the edge at which the swarm is gathered, counter-clockwise from x; default: "
                   "that of the setpoint from the centre of the drop, or without a drop the nearest corner"})
      .add("speed_fraction", &Params::speed_fraction,
           {.min = 1e-3,
            .max = 0.9,
            .doc = "Speed of a moving trap, relative to the speed of the cells",
            .source = "assumed"})
      .add("max_output", &Params::max_output,
           {.min = 1e-3, .max = 1000, .doc = "Largest command in field units", .source = "thesis: 5"})
      .include(&Params::rotation, RotationParams::schema())
      .include(&Params::motion, MotionParams::schema())
      .check([](const Params& p) -> std::string {
        if (p.spread_px > p.compact_px) return {};
        return fmt::format("spread_px = {:g} must be larger than compact_px = {:g}", p.spread_px,
                           p.compact_px);
      })
      .validity(
          "A uniform field without walls cannot make a swarm smaller (F1). The transport by the field "
          "spreads the swarm along the path by the differences in speed; two coils have no trap.");
}

Compact::Compact(const Params& p, const ControlContext& c)
    : p_(p), c_(c), steering_(p.motion, p.max_output, c), trap_({}, c) {
  if (p.transport != Transport::field) return;
  const SwarmMotion motion = p.motion.of(c.motion);
  rotation_.emplace(p.rotation, kRotatingStrength, motion, c);
  circling_.emplace(motion, *rotation_, p.rotation.gain, c);
}

double Compact::max_field() const {
  if (p_.gather == Gathering::trap || p_.transport == Transport::trap)
    return std::numeric_limits<double>::infinity();
  const double holding = (1 + Rotation::kLargestBias) * rotation_->strength();
  return steering_.max_field() + std::max(0.0, holding - steering_.strongest());
}

// Without a drop the trap gathers the swarm where it is.
std::vector<Vec2> Compact::nulls(std::span<const Vec2> setpoints) const {
  std::vector<Vec2> all;
  if (p_.gather == Gathering::trap && c_.drop) all.push_back(c_.drop->centre);
  if (p_.transport == Transport::trap) all.insert(all.end(), setpoints.begin(), setpoints.end());
  return all;
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
  holding_ = false;
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

// Straight at full speed until the remaining way is that of a turn; then circles whose centre drifts to the
// setpoint.
Command Compact::swim(const Estimate& e, Vec2 target, double dt) {
  rotation_->advance(dt);
  const Vec2 way = target - steering_.at_command(e).position;
  const double circle = circling_->speed() / std::abs(rotation_->rate());
  if (norm(way) <= 2 * circle)
    holding_ = true;
  else if (norm(way) > 8 * circle)
    holding_ = false;
  if (!holding_) return steering_.command(e, (1 / norm(way)) * way);
  const double age = e.predicted ? 0 : c_.delay_frames * c_.frame_period;
  const Vec2 field = circling_->hold(e.centroid, target, age, *rotation_);
  return steering_.linear(e.centroid, (1 / steering_.strongest()) * field);
}

Command Compact::transport(const Estimate& e, Vec2 target, double radius, double dt) {
  if (p_.transport == Transport::field) return swim(e, target, dt);
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
