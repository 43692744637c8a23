#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>

#include "control/plan/horizon.h"
#include "control/plan/obstacles.h"
#include "control/plan/place_limits.h"
#include "control/plan/plan_program.h"
#include "control/plant/linear_design.h"
#include "control/plant/steering.h"
#include "core/counted.h"

namespace faba {
namespace {

constexpr int kIterations = 200;      // per frame: a few milliseconds with slew limits on four coils
constexpr double kWithin = 1 - 1e-9;  // of a slew rate: the time between two frames is rounded
constexpr double kPlaceWeight = 100;  // of a violation by error_px, relative to an error of that size

/// Model predictive control (theory F3): the commands of the next `moves` moves that minimise
///   sum_j |e_j|^2 / error^2 + |a_j|^2 + change |a_j - a_(j-1)|^2 + cost to go of the regulator `lqr`
/// under the limits of the coils (current, slew rate, heat), of the view, the drop and obstacles. The plant
/// is linearised along the last plan once per frame. Without active limits the command is that of `lqr`. The
/// solver has a fixed number of iterations, and continues from its last point in the next frame; of that
/// point and the last plan, the one that costs less is used.
class Mpc final : public Controller {
 public:
  struct Obstacle {
    std::vector<Vec2> corners_px;
    static Schema<Obstacle> schema();
  };
  struct Params {
    double max_output = 5;
    double error_px = 2;
    double change = 0;
    int moves = 15;
    int move_frames = 2;
    double margin_px = 0;
    double clearance_px = 10;
    std::vector<Obstacle> obstacle;
    std::optional<double> max_heat;
    MotionParams motion;
  };
  static constexpr std::array kTraits = {Trait::feedback};
  static Schema<Params> schema();
  Mpc(const Params& p, const ControlContext& c);
  Command update(const Estimate& e, const Target& target, double dt) override;
  double max_field() const override { return steering_.max_field(); }
  std::optional<Plan> plan() const override;
  std::vector<Polygon> obstacles() const override { return places_.obstacles(); }
  std::vector<std::string> notes(std::span<const Vec2> setpoints) const override {
    return places_.notes(setpoints);
  }
  void archive(Archive& a) override;

 private:
  static std::vector<Polygon> polygons(const Params& p, const Frame& frame);
  std::vector<Vec2> targets(Vec2 from, Vec2 to) const;
  void add_errors(PlanProgram& program, const Horizon& h, const std::vector<Vec2>& to) const;
  double cost_of(const std::vector<Vec2>& plan, const MeanState& from, const std::vector<Vec2>& to) const;
  void move_towards(const std::vector<Vec2>& solution, const MeanState& from, const std::vector<Vec2>& to);
  CoilLimits coil_limits(Vec2 at) const;
  void count_heat(double dt);
  void keep_limits(Command& command) const;
  Vec2 planned(const MeanState& s, Vec2 to);
  double move_time() const { return p_.move_frames * c_.frame_period; }

  Params p_;
  ControlContext c_;
  Steering steering_;
  LqrDesign design_;
  PlaceLimits places_;
  std::vector<Vec2> plan_;  ///< commands of the last solution
  QuadraticSolution solution_;
  std::vector<double> current_;  ///< A, of the last command
  int frames_ = 0;               ///< since the first plan
  double excess_ = 0;            ///< J, heat so far above the largest mean heat
  /// Where the plan begins; empty if the last command does not follow from a plan.
  std::optional<MeanState> begin_;
  std::vector<PlanLimit> active_;  ///< limits of the plan
};

Schema<Mpc::Obstacle> Mpc::Obstacle::schema() {
  return Schema<Obstacle>("obstacle", "A region that the swarm must not enter")
      .add("corners_px", &Obstacle::corners_px,
           {.unit = "px",
            .min = -1e5,
            .max = 1e5,
            .doc = "Corners of a polygon in image coordinates, y down: [[100, 120], [300, 120], [200, 200]]"})
      .check([](const Obstacle& o) -> std::string {
        if (o.corners_px.size() >= 3) return {};
        return fmt::format("corners_px has {}; a polygon has at least 3 corners",
                           counted(o.corners_px.size(), "corner"));
      })
      .check([](const Obstacle& o) -> std::string {
        if (o.corners_px.size() < 3 || area(o.corners_px) > 0) return {};
        return "all corners of corners_px are on one line; a polygon has an area";
      });
}

Schema<Mpc::Params> Mpc::schema() {
  return Schema<Params>("mpc", "Model predictive control: the best plan within the limits of coils and view")
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
      .add("change", &Params::change,
           {.min = 0,
            .max = 1e6,
            .doc = "Weight of a change of the command between two moves, relative to the command itself",
            .tuned = {1e-3, 10}})
      .add("moves", &Params::moves, {.min = 1, .max = 60, .doc = "Number of moves in the plan"})
      .add("move_frames", &Params::move_frames,
           {.min = 1,
            .max = 60,
            .doc = "Frames for which the plan keeps a command",
            .title = "Frames per move"})
      .add("margin_px", &Params::margin_px,
           {.unit = "px",
            .min = 0,
            .max = 1e4,
            .doc = "Distance that the swarm keeps from the edge of the view and of the drop",
            .title = "Distance from edges"})
      .add("clearance_px", &Params::clearance_px,
           {.unit = "px",
            .min = 0,
            .max = 1e4,
            .doc = "Distance that the swarm keeps from obstacles",
            .source = "assumed",
            .title = "Distance from obstacles"})
      .add("obstacle", &Params::obstacle,
           {.doc = "Regions that the swarm must not enter: [[controller.obstacle]]", .title = "Obstacles"})
      .add(
          "max_heat", &Params::max_heat,
          {.unit = "W",
           .min = 1e-9,
           .max = 1e6,
           .doc = "Largest mean heat of all coils. The mean over a time W is at most max_heat * (1 + T / W), "
                  "with the time T of a plan; default: no limit",
           .title = "Heat of the coils"})
      .include(&Params::motion, MotionParams::schema())
      .validity(
          "The plan is for the mean of the swarm: with a wide swarm, cells enter an obstacle although the "
          "mean "
          "keeps its distance. Limits of places can be violated for a short time; limits of the coils "
          "cannot.");
}

std::vector<Polygon> Mpc::polygons(const Params& p, const Frame& frame) {
  std::vector<Polygon> all;
  for (const Obstacle& o : p.obstacle) {
    Polygon& polygon = all.emplace_back();
    for (const Vec2 corner : o.corners_px) polygon.push_back(frame.world_from_image(corner));
  }
  return all;
}

Mpc::Mpc(const Params& p, const ControlContext& c)
    : p_(p),
      c_(c),
      steering_(p.motion, p.max_output, c),
      design_(lqr_design(linear_plant(steering_.plant(), steering_.strongest()), move_time(),
                         {.error = p.error_px * c.scale.m_per_px})),
      places_(c, p.margin_px * c.scale.m_per_px, p.clearance_px * c.scale.m_per_px, polygons(p, c.frame)),
      plan_(std::size_t(p.moves)),
      current_(c.field->coils(), 0.0) {
  bool heats = false;
  for (std::size_t k = 0; k < c.field->coils(); ++k) heats = heats || c.field->circuit(k).resistance > 0;
  if (p.max_heat && !heats)
    throw Error(
        Errc::usage, "controller.max_heat",
        "the heat is not known, because no coil of the field has a resistance; set resistance in each "
        "[[coil]] of the coil system, or remove max_heat");
}

// Where the swarm is to be after each move: the setpoint, or on a path around the obstacles to it.
std::vector<Vec2> Mpc::targets(Vec2 from, Vec2 to) const {
  std::vector<Vec2> at(plan_.size(), to);
  const std::vector<Vec2> path =
      shortest_path(places_.obstacles(), from, to, p_.clearance_px * c_.scale.m_per_px);
  if (path.size() == 1) return at;
  const LinearPlant plant = linear_plant(steering_.plant(), steering_.strongest());
  const double step = (plant.immediate ? plant.gain : steering_.plant().speed) * move_time();
  std::size_t leg = 0;
  Vec2 p = from;
  for (Vec2& t : at) {
    double left = step;
    while (leg < path.size() && norm(path[leg] - p) <= left) {
      left -= norm(path[leg] - p);
      p = path[leg++];
    }
    if (leg < path.size()) p = p + (left / norm(path[leg] - p)) * (path[leg] - p);
    t = p;
  }
  return at;
}

void Mpc::add_errors(PlanProgram& program, const Horizon& h, const std::vector<Vec2>& to) const {
  const double worth = 1 / (p_.error_px * c_.scale.m_per_px);
  for (std::size_t j = 1; j + 1 < h.states.size(); ++j) {
    const Vec2 e = h.states[j].position - to[j - 1];
    program.add_error(h.by_command[j].topRows(2), Eigen::Vector2d(e.x, e.y),
                      worth * worth * Eigen::Matrix2d::Identity());
  }
  // The cost of all that follows the plan is that of the regulator.
  const Vec2 e = h.states.back().position - to.back(), v = h.states.back().velocity;
  Eigen::Matrix4d cost = Eigen::Matrix4d::Zero();
  cost.diagonal() << design_.cost, design_.cost, design_.cost_velocity, design_.cost_velocity;
  cost(0, 2) = cost(2, 0) = cost(1, 3) = cost(3, 1) = design_.cost_cross;
  program.add_error(h.by_command.back(), Eigen::Vector4d(e.x, e.y, v.x, v.y), cost);
}

CoilLimits Mpc::coil_limits(Vec2 at) const {
  CoilLimits limits;
  limits.offset = steering_.linear(at, {}).current;
  limits.x = steering_.linear(at, {1, 0}).current;
  limits.y = steering_.linear(at, {0, 1}).current;
  limits.max_current = c_.max_current;
  limits.before = current_;
  for (std::size_t k = 0; k < limits.offset.size(); ++k) {
    limits.x[k] -= limits.offset[k];
    limits.y[k] -= limits.offset[k];
    limits.resistance.push_back(c_.field->circuit(k).resistance);
  }
  limits.max_slew = c_.max_slew;
  limits.max_heat = p_.max_heat;
  if (p_.max_heat) limits.spent = std::min(excess_ / (*p_.max_heat * p_.moves * move_time()), 1.0);
  limits.first_time = c_.frame_period;
  limits.move_time = move_time();
  return limits;
}

// The cost of a plan without linearisation.
double Mpc::cost_of(const std::vector<Vec2>& plan, const MeanState& from, const std::vector<Vec2>& to) const {
  const std::vector<MeanState> states =
      expected_states(steering_.plant(), from, plan, steering_.strongest(), move_time());
  const double unit = p_.error_px * c_.scale.m_per_px, worth = 1 / (unit * unit);
  double cost = 0;
  for (std::size_t i = 0; i < plan.size(); ++i) {
    cost += dot(plan[i], plan[i]);
    if (i > 0) cost += p_.change * dot(plan[i] - plan[i - 1], plan[i] - plan[i - 1]);
    const MeanState& s = states[i + 1];
    const Vec2 e = s.position - to[i];
    if (i + 1 < plan.size())
      cost += worth * dot(e, e);
    else
      cost += design_.cost * dot(e, e) + 2 * design_.cost_cross * dot(e, s.velocity) +
              design_.cost_velocity * dot(s.velocity, s.velocity);
    for (const PlaceLimit& edge : places_.near(s.position))
      if (edge.room < 0) cost += kPlaceWeight * worth * edge.room * edge.room;
  }
  return cost;
}

// The solution is that of a linear plant. As far towards it as the cost of the true one decreases.
void Mpc::move_towards(const std::vector<Vec2>& solution, const MeanState& from,
                       const std::vector<Vec2>& to) {
  double least = std::numeric_limits<double>::infinity();
  const std::vector<Vec2> last = plan_;
  for (const double share : {1.0, 0.5, 0.25, 0.1, 0.0}) {
    std::vector<Vec2> plan = last;
    for (std::size_t i = 0; i < plan.size(); ++i) plan[i] = last[i] + share * (solution[i] - last[i]);
    const double cost = cost_of(plan, from, to);
    if (!(cost < least)) continue;
    least = cost;
    plan_ = std::move(plan);
  }
}

Vec2 Mpc::planned(const MeanState& s, Vec2 to) {
  if (++frames_ % p_.move_frames == 0) {  // the first move of the last plan is done
    plan_.erase(plan_.begin());
    plan_.push_back(plan_.empty() ? Vec2{} : plan_.back());
  }
  const std::vector<Vec2> at = targets(s.position, to);
  const Horizon h = horizon(steering_.plant(), s, plan_, steering_.strongest(), move_time());
  PlanProgram program(plan_);
  add_errors(program, h, at);
  program.add_effort(p_.change);
  program.limit(coil_limits(s.position));
  for (std::size_t j = 1; j < h.states.size(); ++j)
    for (const PlaceLimit& edge : places_.near(h.states[j].position))
      program.keep(edge.limit, h.by_command[j].topRows(2), edge.direction, edge.room,
                   p_.error_px * c_.scale.m_per_px, kPlaceWeight);
  solution_ = solve(program.take(), solution_, kIterations);
  if (!solution_.x.allFinite()) {
    solution_ = {};
    std::fill(plan_.begin(), plan_.end(), Vec2{});
    return -1.0 * (design_.position * (s.position - at.back()) + design_.velocity * s.velocity);
  }
  std::vector<Vec2> solution;
  for (Eigen::Index i = 0; i < solution_.x.size(); i += 2) {
    const Vec2 a{solution_.x[i], solution_.x[i + 1]};
    solution.push_back((1 / std::max(1.0, norm(a))) * a);
  }
  move_towards(solution, s, at);
  begin_ = s;
  active_ = program.active(solution_);
  return plan_.front();
}

// A plan uses most of its heat at its beginning, and is made again in every frame: what was used above the
// mean is subtracted from the next plans.
void Mpc::count_heat(double dt) {
  if (!p_.max_heat) return;
  double heat = 0;
  for (std::size_t k = 0; k < current_.size(); ++k)
    heat += c_.field->circuit(k).resistance * current_[k] * current_[k];
  excess_ = std::max(0.0, excess_ + (heat - *p_.max_heat) * dt);
}

// Exactly: the solver keeps the limits to its tolerance, and the command of the regulator does not know them.
void Mpc::keep_limits(Command& command) const {
  for (std::size_t k = 0; k < current_.size(); ++k) {
    double& current = command.current[k];
    if (c_.max_slew) {
      const double change = kWithin * *c_.max_slew * c_.frame_period;
      current = std::clamp(current, current_[k] - change, current_[k] + change);
    }
    if (k < c_.max_current.size()) current = std::clamp(current, -c_.max_current[k], c_.max_current[k]);
  }
}

std::optional<Plan> Mpc::plan() const {
  if (!begin_) return std::nullopt;
  Plan plan{.path = {}, .step = move_time(), .active = active_};
  for (const MeanState& s :
       expected_states(steering_.plant(), *begin_, plan_, steering_.strongest(), move_time()))
    plan.path.push_back(s.position);
  return plan;
}

Command Mpc::update(const Estimate& e, const Target& target, double dt) {
  count_heat(dt);
  begin_.reset();
  const MeanState s = steering_.at_command(e);
  Command command;
  if (e.visible > 0 && std::isfinite(norm(s.position - target.position)) && std::isfinite(norm(s.velocity)))
    command = steering_.command(e, planned(s, target.position));
  else
    command = steering_.none();
  if (e.visible > 0) keep_limits(command);
  current_ = command.current;
  return command;
}

void Mpc::archive(Archive& a) {
  a& steering_& current_& excess_& frames_;
  for (Vec2& move : plan_) a& move;
  std::vector<double> x(solution_.x.begin(), solution_.x.end());
  std::vector<double> multipliers(solution_.multipliers.begin(), solution_.multipliers.end());
  a& x& multipliers;
  solution_.x = Eigen::Map<Eigen::VectorXd>(x.data(), Eigen::Index(x.size()));
  solution_.multipliers = Eigen::Map<Eigen::VectorXd>(multipliers.data(), Eigen::Index(multipliers.size()));
}

}  // namespace

void add_mpc(ControllerRegistry& r) { r.add<Mpc>(); }

}  // namespace faba
