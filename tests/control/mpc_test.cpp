// Laws of model predictive control: it is the regulator when no limit is active, and keeps the limits.
#include <doctest/doctest.h>

#include <cmath>

#include "app/scenario/scenario.h"
#include "control/plan/obstacles.h"
#include "control/plant/motion_model.h"
#include "tests/reference_rig.h"

using namespace faba;

namespace {

const Parts kParts = builtin_parts();
constexpr double kPx = 1e-6;  // m per px of these tests
constexpr double kPeriod = 1.0 / 60;
const SwarmMotion kDipole{.speed = 186e-6, .turning = 1.3e5, .diffusion = 0.54};
const SwarmMotion kBasic{.response = SwarmMotion::Response::proportional, .mobility = 0.6};

ControlContext context(const SwarmMotion& motion, const std::string& field = "f = 'uniform'") {
  const Document d = parse_toml(field, "test");
  ControlContext c;
  c.field = kParts.field.resolve(Node(d).child("f")).make({});
  c.scale = {kPx, kPeriod, 23e-6};
  c.frame = {kPx, 640, 480, {319.5, 239.5}};
  c.polarity = 1;
  c.frame_period = kPeriod;
  c.max_current = c.field->max_currents(2);
  c.motion = motion;
  return c;
}
std::unique_ptr<Controller> controller(const std::string& toml, const ControlContext& c) {
  const Document d = parse_toml("[p]\n" + toml, "test");
  return kParts.controller.resolve(Node(d).child("p")).make(c);
}
Estimate at(const MeanState& s) {
  Estimate e;
  e.centroid = s.position;
  e.velocity = s.velocity;
  e.visible = 100;
  e.predicted = true;
  return e;
}

/// Steers the plant from `from` to the origin for `time` s; calls `look` with every state and command.
template <class Look>
MeanState steer(Controller& c, const ControlContext& context, Vec2 from, double time, const Look& look) {
  MeanState s{from, {}};
  for (int k = 0; k < int(time / kPeriod); ++k) {
    const Command command = c.update(at(s), {{}, 0, false}, kPeriod);
    look(s, command);
    s = advanced(context.motion, 1, s, field_along(context, s.position, command), kPeriod);
  }
  return s;
}

}  // namespace

TEST_CASE("mpc: without active limits the command is that of the regulator") {
  const ControlContext c = context(kBasic);
  const auto mpc = controller("type = 'mpc'\nmove_frames = 1\nmoves = 12", c);
  const auto lqr = controller("type = 'lqr'", c);
  for (const Vec2 from : {Vec2{1e-6, 0}, Vec2{-3e-7, 8e-7}, Vec2{0, 2e-7}}) {
    const Command a = mpc->update(at({from, {}}), {}, kPeriod), b = lqr->update(at({from, {}}), {}, kPeriod);
    // The tolerance of the solver is 1e-3 of the full command.
    const double full = 5 * 23e-6;
    const Vec2 difference = field_along(c, {}, a) - field_along(c, {}, b);
    CHECK(norm(difference) < 1e-3 * full);
    CHECK(norm(field_along(c, {}, b)) > 0.05 * full);
  }
}

TEST_CASE("mpc: reaches the setpoint from far away, with and without a turning time") {
  for (const SwarmMotion& motion : {kDipole, kBasic}) {
    const ControlContext c = context(motion);
    const auto mpc = controller("type = 'mpc'", c);
    const MeanState end = steer(*mpc, c, {-200e-6, 100e-6}, 6, [](const MeanState&, const Command&) {});
    CHECK(norm(end.position) < 1e-6);
  }
}

TEST_CASE("mpc: currents, their rates and the heat stay within the limits") {
  std::string rig = "[f]\ntype = 'rig'\nearth = { field = ['18 uT', '-9 uT', 0] }\n";
  for (const int angle : {0, 90, 180, 270})
    rig += reference_coils("f.coil", {double(angle)}) + "resistance = 5\n";
  ControlContext c = context(kDipole, rig);
  c.max_current.assign(4, 0.05);
  c.max_slew = 0.5;
  double mean_heat = 0, most_heat = 0;
  for (const bool limited : {false, true}) {
    const std::string heat = limited ? "\nmax_heat = '" + std::to_string(mean_heat / 2) + " W'" : "";
    const auto mpc = controller("type = 'mpc'\nmax_output = 20" + heat, c);
    std::vector<double> before(4, 0.0);
    double energy = 0;
    constexpr double kTolerance = 1e-9;
    constexpr double kTime = 3;
    steer(*mpc, c, {-200e-6, 100e-6}, kTime, [&](const MeanState&, const Command& command) {
      for (std::size_t k = 0; k < 4; ++k) {
        CHECK(std::fabs(command.current[k]) <= 0.05 * (1 + kTolerance));
        CHECK(std::fabs(command.current[k] - before[k]) <=
              (0.5 * kPeriod) * (1 + kTolerance) + 0.05 * kTolerance);
        const double heat_now = c.field->circuit(k).resistance * command.current[k] * command.current[k];
        energy += heat_now * kPeriod;
      }
      before = command.current;
    });
    if (!limited) {
      mean_heat = energy / kTime;
      REQUIRE(mean_heat > 0);
    } else {
      most_heat = energy / kTime;
      // What a plan may use at once is its own time, 0.5 s, of the mean.
      CHECK(most_heat <= mean_heat / 2 * (1 + 0.5 / kTime));
    }
  }
}

TEST_CASE("mpc: keeps its distance from the edge of a drop, also a large one") {
  ControlContext c = context(kDipole);
  c.drop = Disc{{}, 220e-6};
  for (const double margin : {20.0, 150.0}) {
    CAPTURE(margin);
    const auto mpc = controller("type = 'mpc'\nmargin_px = " + std::to_string(margin), c);
    const Vec2 outside{(220 - margin + 10) * kPx, 0};
    double farthest = 0;
    MeanState s{};
    for (int k = 0; k < 600; ++k) {
      const Command command = mpc->update(at(s), {outside, 0, false}, kPeriod);
      s = advanced(c.motion, 1, s, field_along(c, s.position, command), kPeriod);
      farthest = std::max(farthest, norm(s.position));
    }
    // A violation by error_px = 2 px costs 100 times an error of that size: of 10 px it is worth 0.1 px, and
    // a swarm that arrives with its inertia passes the limit by less than error_px.
    CHECK(farthest < (220 - margin + 2) * kPx);
    CHECK(norm(s.position) > (220 - margin - 2) * kPx);
    const std::vector<Vec2> setpoints{{}, outside};
    const std::vector<std::string> notes = mpc->notes(setpoints);
    REQUIRE(notes.size() == 1);
    CHECK(notes[0].find("keeps the swarm away from the edge, and stops it 10 px before the setpoint") !=
          std::string::npos);
  }
  // Of a setpoint outside of the drop every run has a note.
  const std::vector<Vec2> beyond{{230 * kPx, 0}};
  CHECK(controller("type = 'mpc'", c)->notes(beyond).empty());
  CHECK_THROWS_AS(controller("type = 'mpc'\nmargin_px = 225", c), Error);
}

TEST_CASE("mpc: a setpoint in an obstacle is noted, and a polygon without area is refused") {
  const ControlContext c = context(kDipole);
  const std::string keys = "type = 'mpc'\nclearance_px = 10\n[[p.obstacle]]\ncorners_px = ";
  const auto mpc = controller(keys + "[[300, 200], [340, 200], [340, 300], [300, 300]]", c);
  // The centre of the view, (319.5, 239.5) px, is 19.5 px from the nearest side.
  const std::vector<Vec2> centre{{}};
  const std::vector<std::string> notes = mpc->notes(centre);
  REQUIRE(notes.size() == 1);
  CHECK(notes[0].find("away from an obstacle, and stops it 29.5 px before the setpoint") !=
        std::string::npos);
  CHECK_THROWS_AS(controller(keys + "[[300, 200], [340, 200], [380, 200]]", c), Error);
}

TEST_CASE("mpc: goes around an obstacle and keeps its distance") {
  const ControlContext c = context(kDipole);
  const std::string obstacle =
      "\n[[p.obstacle]]\ncorners_px = [[260, 200], [300, 200], [300, 300], [260, 300]]";
  const auto mpc = controller("type = 'mpc'\nclearance_px = 12" + obstacle, c);
  Polygon polygon;
  for (const Vec2 corner : {Vec2{260, 200}, Vec2{300, 200}, Vec2{300, 300}, Vec2{260, 300}})
    polygon.push_back(c.frame.world_from_image(corner));
  double nearest = 1;
  const MeanState end = steer(*mpc, c, {-150e-6, 0}, 8, [&](const MeanState& s, const Command&) {
    nearest = std::min(nearest, nearest_edge(polygon, s.position).distance);
  });
  MESSAGE("smallest distance ", nearest / kPx, " px");
  CHECK(norm(end.position) < 2e-6);
  // The clearance is soft: a violation by error_px = 2 px costs as much as an error of 20 px.
  CHECK(nearest > 10 * kPx);
}

TEST_CASE("mpc: a checkpoint continues with the same commands") {
  const ControlContext c = context(kDipole);
  const auto one = controller("type = 'mpc'", c);
  MeanState s = steer(*one, c, {-100e-6, 0}, 0.5, [](const MeanState&, const Command&) {});
  Archive out;
  one->archive(out);
  const auto two = controller("type = 'mpc'", c);
  Archive in(out.bytes());
  two->archive(in);
  CHECK(in.at_end());
  for (int k = 0; k < 10; ++k) {
    const Command a = one->update(at(s), {}, kPeriod), b = two->update(at(s), {}, kPeriod);
    CHECK(a.current == b.current);
    s = advanced(c.motion, 1, s, field_along(c, s.position, a), kPeriod);
  }
}

TEST_CASE("mpc: the plan begins at the swarm and follows the plant") {
  const ControlContext c = context(kDipole);
  const auto mpc = controller("type = 'mpc'\nmoves = 10\nmove_frames = 2", c);
  CHECK(!mpc->plan());
  const MeanState s{{-100e-6, 20e-6}, {30e-6, 5e-6}};
  const Command command = mpc->update(at(s), {}, kPeriod);
  const auto plan = mpc->plan();
  REQUIRE(plan);
  CHECK(plan->step == doctest::Approx(2 * kPeriod));
  REQUIRE(plan->path.size() == 11);
  CHECK(norm(plan->path[0] - s.position) < 1e-12);
  const Vec2 expected = advanced(c.motion, 1, s, field_along(c, s.position, command), 2 * kPeriod).position;
  REQUIRE(norm(expected - s.position) > 1e-6);
  CHECK(norm(plan->path[1] - expected) < 1e-9);
  // The path approaches the setpoint.
  CHECK(norm(plan->path.back()) < norm(plan->path.front()));

  Estimate lost = at(s);
  lost.visible = 0;
  mpc->update(lost, {}, kPeriod);
  CHECK(!mpc->plan());
  const auto regulator = controller("type = 'lqr'", c);
  regulator->update(at(s), {}, kPeriod);
  CHECK(!regulator->plan());
}

TEST_CASE("mpc: the plan names the limits that are active, and no others") {
  std::string rig = "[f]\ntype = 'rig'\n";
  for (const int angle : {0, 90, 180, 270})
    rig += reference_coils("f.coil", {double(angle)}) + "resistance = 5\n";
  using Limits = std::vector<PlanLimit>;
  const auto active = [](const std::string& toml, const ControlContext& c, Vec2 from) {
    const auto mpc = controller("type = 'mpc'\nmove_frames = 1\n" + toml, c);
    mpc->update(at({from, {}}), {}, kPeriod);
    REQUIRE(mpc->plan());
    return mpc->plan()->active;
  };
  ControlContext c = context(kBasic, rig);
  c.max_current.assign(4, 2);
  const Vec2 far{-10e-6, 0}, near{-0.05e-6, 0};
  CHECK(active("", c, near) == Limits{});
  CHECK(active("", c, far) == Limits{PlanLimit::output});
  ControlContext weak = c;
  weak.max_current.assign(4, 0.01);
  CHECK(active("", weak, near) == Limits{});
  CHECK(active("", weak, far) == Limits{PlanLimit::current});
  ControlContext slow = c;
  slow.max_slew = 1;
  CHECK(active("", slow, near) == Limits{});
  CHECK(active("", slow, {-1e-6, 0}) == Limits{PlanLimit::slew});
  CHECK(active("max_heat = '0.1 mW'", c, far) == Limits{PlanLimit::heat});
  CHECK(active("max_heat = '0.1 mW'", c, near) == Limits{});

  const ControlContext free = context(kBasic);  // moves at once: the setpoint is at the edge of the view
  const auto mpc = controller("type = 'mpc'\nmargin_px = 20", free);
  mpc->update(at({{300e-6, 0}, {}}), {{318e-6, 0}, 0, false}, kPeriod);
  REQUIRE(mpc->plan());
  CHECK(mpc->plan()->active == Limits{PlanLimit::view});
  ControlContext inside = free;
  inside.drop = Disc{{}, 200e-6};
  const auto drop = controller("type = 'mpc'\nmargin_px = 20", inside);
  drop->update(at({{180e-6, 0}, {}}), {{190e-6, 0}, 0, false}, kPeriod);
  CHECK(drop->plan()->active == Limits{PlanLimit::drop});
  const auto wall = controller(
      "type = 'mpc'\n[[p.obstacle]]\ncorners_px = [[330, 200], [400, 200], [400, 280], [330, 280]]", free);
  wall->update(at({{1e-6, 0}, {}}), {{4e-6, 0}, 0, false}, kPeriod);
  CHECK(wall->plan()->active == Limits{PlanLimit::obstacle});
}
