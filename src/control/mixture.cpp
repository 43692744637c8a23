#include <fmt/format.h>

#include <Eigen/Eigenvalues>
#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

#include "control/plant/motion_model.h"
#include "control/plant/rotation.h"
#include "control/plant/swarm_pair.h"
#include "control/two_swarms.h"
#include "field/allocate.h"

namespace faba {
namespace {

constexpr double kNone = std::numeric_limits<double>::quiet_NaN();

/// Steers two swarms of different polarity or speed to a setpoint each (theory F3). Both circle in a rotating
/// field and drift by a constant bias that the coils make different at the two swarms,
///   u_i = q_i (v_i / 2) B_dc(p_i) / B_rot, turned by phi*_i,
/// with q_i = -1 for a swarm that swims against the field. The currents are the solution of
///   sum over i of v_i^2 |B_dc(p_i) - b_i|^2 = min,   b_i: the bias for u_i = sat(k (r_i - p_i)),
/// with the least heat relative to the limits, without the patterns of (B_dc(p_1), B_dc(p_2)) that the coils
/// make only very weakly, and scaled to the limits. In a uniform field the weights v_i^2 stop the swarms
/// where the sum of the squared distances is smallest. Assumed: the swarms are small compared with their
/// distance.
class Mixture final : public TwoSwarmController {
 public:
  enum class First { majority, north, south };
  enum class Polarity { opposite, same };
  struct Params {
    std::optional<Vec2> second_px, near_px;
    First first_polarity = First::majority;
    Polarity second_polarity = Polarity::opposite;
    std::optional<double> second_speed, second_turning, second_mobility;
    RotationParams rotation;
    MotionParams motion;
  };
  static constexpr std::array kTraits = {Trait::feedback};
  static Schema<Params> schema();
  Mixture(const Params& p, const ControlContext& c);
  Command update(const Estimate& e, const Target& target, double dt) override;
  double max_field() const override {
    return (1 + Rotation::kLargestBias) * rotation_.strength() + norm(ambient());
  }
  std::vector<std::string> notes(std::span<const Vec2> setpoints) const override;
  std::array<double, 2> distances() const override {
    return pair_.resolved() ? distance_
                            : std::array{distance_[0], kNone};  // a second swarm needs a second group
  }
  void archive(Archive& a) override { a& rotation_& pair_& second_target_& distance_[0] & distance_[1]; }
  std::optional<Vec2> second_setpoint() const override {
    return p_.second_px ? std::optional(second_target_) : std::nullopt;
  }
  bool opposite() const override { return sign_[1] < 0; }

 private:
  using Vec4 = Eigen::Vector4d;
  using Fields = Eigen::Matrix<double, 4, Eigen::Dynamic>;
  using Pair = std::array<Vec2, 2>;
  /// Fields that the coils make at two positions.
  struct Patterns {
    Fields by_current;  ///< weighted field at both positions per current, relative to its limit, T
    Eigen::Matrix4d directions;
    Vec4 squares;  ///< of the weighted field of unit currents, T^2; ascending
    int used = 0;  ///< number of directions that are strong enough, the last ones
  };

  Vec2 ambient() const { return {c_.field->ambient().x, c_.field->ambient().y}; }
  Patterns patterns(const Pair& at) const;
  Pair drifts(const Pair& target, bool independent) const;
  std::vector<double> carrier() const;
  Pair add_bias(const Patterns& p, const Pair& wanted, std::vector<double>& current) const;

  Params p_;
  ControlContext c_;
  Rotation rotation_;
  std::array<CirclingSwarm, 2> swarms_;
  std::array<double, 2> sign_, weight_;
  std::vector<double> spare_;  ///< current that the rotating field leaves for the bias, A
  SwarmPair pair_;
  Vec2 second_target_;
  std::array<double, 2> distance_ = {kNone, kNone};  ///< m, of distances()
};

constexpr double kMixtureStrength = 3e-4;  // T
// A bias of 1 % of the rotating field moves a swarm with 0.5 % of its speed.
constexpr double kWeakest = 0.01;

SwarmMotion second_motion(const Mixture::Params& p, SwarmMotion m) {
  m.speed = p.second_speed.value_or(m.speed);
  m.turning = p.second_turning.value_or(m.turning);
  m.mobility = p.second_mobility.value_or(m.mobility);
  return m;
}

Schema<Mixture::Params> Mixture::schema() {
  return Schema<Params>("mixture", "Two swarms of different polarity or speed, steered to a setpoint each")
      .add("second_px", &Params::second_px,
           {.unit = "px",
            .min = -1e5,
            .max = 1e5,
            .doc = "Setpoint of the second swarm in image coordinates, y down; the reference gives that of "
                   "the first; default: where the second swarm is first recognised",
            .title = "Setpoint of the second swarm"})
      .add("near_px", &Params::near_px,
           {.unit = "px",
            .min = -1e5,
            .max = 1e5,
            .doc = "Initial position of the first swarm in image coordinates; default: that of the estimate. "
                   "Which swarm is the first is decided by how they circle in the first turns of the field",
            .title = "Initial position of the first swarm"})
      .add("first_polarity", &Params::first_polarity,
           {.doc = "Polarity of the first swarm; majority: that of most cells, south if there are as many of "
                   "both",
            .choices = {"majority", "north", "south"},
            .title = "Polarity of the first swarm"})
      .add("second_polarity", &Params::second_polarity,
           {.doc = "Polarity of the second swarm, relative to the first",
            .choices = {"opposite", "same"},
            .title = "Polarity of the second swarm"})
      .add("second_speed", &Params::second_speed,
           {.unit = "m/s",
            .min = 1e-8,
            .max = 1e-2,
            .doc = "Swimming speed of the second swarm; default: that of the first",
            .title = "Speed of the second swarm"})
      .add("second_turning", &Params::second_turning,
           {.unit = "rad/(s T)",
            .min = 1,
            .max = 1e9,
            .doc = "Turning rate of the second swarm, per tesla; default: that of the first",
            .title = "Turning rate of the second swarm"})
      .add("second_mobility", &Params::second_mobility,
           {.unit = "m/(s T)",
            .min = 1e-6,
            .max = 1e6,
            .doc = "Drift per tesla of the second swarm, for a drift proportional to the field; default: "
                   "that of the first",
            .title = "Drift per tesla of the second swarm"})
      .include(&Params::rotation, RotationParams::schema())
      .include(&Params::motion, MotionParams::schema())
      .validity(
          "Both swarms reach their setpoints only if the fields of the coils differ enough between them, "
          "which takes coils in at least four directions and a distance of the swarms of more than their "
          "size. The estimator must separate the swarms.");
}

Mixture::Mixture(const Params& p, const ControlContext& c)
    : p_(p),
      c_(c),
      rotation_(p.rotation, kMixtureStrength, p.motion.of(c.motion), c),
      swarms_{CirclingSwarm(p.motion.of(c.motion), rotation_, p.rotation.gain, c),
              CirclingSwarm(second_motion(p, p.motion.of(c.motion)), rotation_, p.rotation.gain, c)},
      sign_{1, p.second_polarity == Polarity::same ? 1.0 : -1.0},
      pair_(swarms_, sign_,
            p.near_px ? std::optional(c.frame.world_from_image(*p.near_px)) : std::optional<Vec2>()) {
  if (p.first_polarity != First::majority) c_.polarity = p.first_polarity == First::north ? 1 : -1;
  const double first = swarms_[0].mobility(), second = swarms_[1].mobility();
  const double mean = std::sqrt((first * first + second * second) / 2);
  weight_ = mean > 0 ? std::array{first / mean, second / mean} : std::array{1.0, 1.0};
  if (p.second_px) second_target_ = c.frame.world_from_image(*p.second_px);

  const std::vector<double> x = allocate(*c.field, {}, {1, 0}), y = allocate(*c.field, {}, {0, 1});
  const double carried = rotation_.strength() + norm(ambient());
  constexpr double kLeast = 0.01;  // of the limit
  for (std::size_t k = 0; k < c.field->coils(); ++k) {
    const bool limited = k < c.max_current.size() && std::isfinite(c.max_current[k]);
    const double most = limited ? c.max_current[k] : 1.0;
    spare_.push_back(limited ? std::max(most - carried * norm(Vec2{x[k], y[k]}), kLeast * most) : most);
  }
}

Mixture::Patterns Mixture::patterns(const Pair& at) const {
  Patterns p;
  const auto coils = Eigen::Index(c_.field->coils());
  p.by_current = Fields::Zero(4, coils);
  std::vector<Vec3> b(c_.field->coils());
  for (std::size_t i = 0; i < 2; ++i) {
    c_.field->basis({at[i].x, at[i].y, 0}, b, {});
    for (Eigen::Index k = 0; k < coils; ++k) {
      const Vec3 here = (weight_[i] * spare_[std::size_t(k)]) * b[std::size_t(k)];
      p.by_current(2 * Eigen::Index(i), k) = here.x;
      p.by_current(2 * Eigen::Index(i) + 1, k) = here.y;
    }
  }
  const Eigen::Matrix4d square = p.by_current * p.by_current.transpose();
  if (!square.allFinite()) return p;
  const Eigen::SelfAdjointEigenSolver<Eigen::Matrix4d> solver(square);
  p.directions = solver.eigenvectors();
  p.squares = solver.eigenvalues();
  // All coils at their limits make sqrt(coils) times the field of unit currents, shared by the two swarms.
  const double least = 2 * std::pow(kWeakest * rotation_.strength(), 2) / double(coils);
  while (p.used < 4 && p.squares[3 - p.used] >= least) ++p.used;
  return p;
}

// With a common field one swarm must not be limited more than the other: the ratio of both decides where they
// stop.
Mixture::Pair Mixture::drifts(const Pair& target, bool independent) const {
  const double gain = std::min(swarms_[0].gain(), swarms_[1].gain());
  Pair wanted;
  std::array<double, 2> size{};
  for (std::size_t i = 0; i < 2; ++i) {
    wanted[i] = gain * (target[i] - pair_.centre(i));
    if (!std::isfinite(norm(wanted[i]))) wanted[i] = {};
    size[i] = std::max(1.0, norm(wanted[i]) / std::max(swarms_[i].max_drift(), 1e-12));
  }
  const double common = std::max(size[0], size[1]);
  for (std::size_t i = 0; i < 2; ++i) wanted[i] = (1 / (independent ? size[i] : common)) * wanted[i];
  return wanted;
}

std::vector<double> Mixture::carrier() const {
  const Vec2 middle = 0.5 * (pair_.centre(0) + pair_.centre(1));
  return allocate(*c_.field, {middle.x, middle.y, 0}, double(c_.polarity) * rotation_.field() - ambient());
}

// Returns the bias that is made at both swarms, T.
Mixture::Pair Mixture::add_bias(const Patterns& p, const Pair& wanted, std::vector<double>& current) const {
  Vec4 b;
  b << weight_[0] * wanted[0].x, weight_[0] * wanted[0].y, weight_[1] * wanted[1].x, weight_[1] * wanted[1].y;
  Vec4 solved = Vec4::Zero();
  for (int j = 4 - p.used; j < 4; ++j)
    solved += (p.directions.col(j).dot(b) / p.squares[j]) * p.directions.col(j);
  const Eigen::VectorXd relative = p.by_current.transpose() * solved;
  if (!relative.allFinite()) return {};
  double scale = 1;
  for (std::size_t k = 0; k < current.size(); ++k) {
    const double added = spare_[k] * relative[Eigen::Index(k)];
    if (k >= c_.max_current.size() || added == 0) continue;
    const double room = c_.max_current[k] - (added > 0 ? current[k] : -current[k]);
    scale = std::clamp(room / std::fabs(added), 0.0, scale);
  }
  for (std::size_t k = 0; k < current.size(); ++k)
    current[k] += scale * spare_[k] * relative[Eigen::Index(k)];
  const Vec4 made = scale * p.by_current * relative;
  Pair field;
  for (std::size_t i = 0; i < 2; ++i)
    if (weight_[i] > 0)
      field[i] = (1 / weight_[i]) * Vec2{made[2 * Eigen::Index(i)], made[2 * Eigen::Index(i) + 1]};
  return field;
}

Command Mixture::update(const Estimate& e, const Target& target, double dt) {
  if (!(e.visible > 0) || !std::isfinite(norm(e.centroid)))
    return {std::vector<double>(c_.field->coils(), 0.0)};
  rotation_.advance(dt);
  std::vector<Group> groups = e.groups;
  std::erase_if(groups, [](const Group& g) { return !std::isfinite(norm(g.centroid)); });
  const bool predicted = groups.empty() && e.predicted;
  const double age = predicted ? 0 : c_.delay_frames * c_.frame_period;
  const bool decided = pair_.follow(groups, e.centroid, age, dt, rotation_);
  if (decided && !p_.second_px) second_target_ = pair_.centre(1);
  const Pair at{pair_.centre(0), pair_.centre(1)};
  distance_ = {norm(target.position - at[0]), norm(second_target_ - at[1])};

  const Patterns p = patterns(at);
  const Pair drift = drifts({target.position, second_target_}, p.used == 4);
  Pair wanted;
  for (std::size_t i = 0; i < 2; ++i)
    wanted[i] = (c_.polarity * sign_[i]) * swarms_[i].bias(drift[i], rotation_);
  std::vector<double> current = carrier();
  const Pair made = add_bias(p, wanted, current);
  for (std::size_t i = 0; i < 2; ++i)
    pair_.set_velocity(i, swarms_[i].drift_by((c_.polarity * sign_[i]) * made[i], rotation_));
  return {current};
}

std::vector<std::string> Mixture::notes(std::span<const Vec2> setpoints) const {
  std::vector<std::string> notes;
  if (!c_.field->varies()) {
    notes.push_back(fmt::format(
        "the field is the same at both swarms and cannot steer them independently: v2 p1 {} v1 p2 of their "
        "mean positions p1 and p2 stays constant, with v1 = {:.3g} um/s and v2 = {:.3g} um/s; the "
        "controller moves them to where the sum of the squared distances from the setpoints is smallest; "
        "use coils in at least four directions, as in rigs/eight-coils.toml",
        sign_[1] > 0 ? "-" : "+", swarms_[0].speed() * 1e6, swarms_[1].speed() * 1e6));
    return notes;
  }
  if (!p_.second_px) return notes;
  for (const Vec2 at : setpoints) {
    const int used = patterns({at, second_target_}).used;
    if (used == 4) continue;
    const Vec2 first = c_.frame.image_from_world(at);
    notes.push_back(fmt::format(
        "with the swarms at ({:.0f}, {:.0f}) px and ({:.0f}, {:.0f}) px the coils make only {} of the 4 "
        "components of both fields with at least 1 % of the rotating field; along the others the sum of the "
        "squared distances from the setpoints becomes as small as possible; choose setpoints that are "
        "further apart, or, with less than eight coils, coils as in rigs/eight-coils.toml",
        first.x, first.y, p_.second_px->x, p_.second_px->y, used));
    break;
  }
  return notes;
}

}  // namespace

void add_mixture(ControllerRegistry& r) { r.add<Mixture>(); }

}  // namespace faba
