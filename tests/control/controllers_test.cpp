#include <doctest/doctest.h>

#include "tests/reference_rig.h"

#include "app/scenario/scenario.h"

using namespace faba;

namespace {

const Parts kParts = builtin_parts();
constexpr double kPx = 1e-6;  // m per px of these tests

ControlContext context(int polarity = 1, int delay = 0) {
  Document d;
  d.root = Json{{"field", Json{{"type", "uniform"}, {"gain", 1}}}};
  ControlContext c;
  c.field = kParts.field.resolve(Node(d).child("field")).make({});
  c.scale = {kPx, 1.0 / 15, 1.0};  // field unit 1 T: currents equal field units
  c.frame = {kPx, 640, 480, {319.5, 239.5}};
  c.polarity = polarity;
  c.frame_period = 1.0 / 15;
  c.delay_frames = delay;
  return c;
}
template <class Registry>
auto part(const Registry& r, const std::string& toml, const ControlContext& c) {
  const Document d = parse_toml(toml, "test");
  return r.resolve(Node(d).child("p")).make(c);
}
Estimate at(Vec2 px, double visible = 100) {
  Estimate e;
  e.centroid = kPx * px;
  e.visible = visible;
  return e;
}
Vec2 output(Controller& c, Vec2 px) {
  const Command out = c.update(at(px), {{0, 0}, 0, false}, 1.0 / 15);
  return {out.current[0], out.current[1]};
}

}  // namespace

TEST_CASE("T10: fuzzy strength at the distances of the thesis (A9)") {
  const auto fuzzy = part(kParts.controller, "p = 'fuzzy'", context());
  const double table[][2] = {{40, 2.5}, {60, 3.125}, {80, 3.75}, {100, 4.375},
                             {120, 5},  {300, 5},    {1e-3, 2.5}};
  for (const auto& [d, strength] : table) {
    CHECK(norm(output(*fuzzy, {d, 0})) == doctest::Approx(strength).epsilon(1e-12));
    CHECK(norm(output(*fuzzy, {0.6 * d, -0.8 * d})) == doctest::Approx(strength).epsilon(1e-12));
  }
  CHECK(output(*fuzzy, {300, 0}).x < 0);  // towards the setpoint
  CHECK(norm(output(*fuzzy, {0, 0})) == 0);
}

TEST_CASE("fuzzy: custom sets, zero output in gaps, vertical edges") {
  const auto fuzzy =
      part(kParts.controller,
           "[p]\ntype = 'fuzzy'\n[[p.set]]\nname = 'at'\ntrapezoid_px = [0, 0, 2, 2]\noutput = 0\n"
           "[[p.set]]\nname = 'near'\ntrapezoid_px = [2, 2, 50, 50]\noutput = 1.5\n"
           "[[p.set]]\nname = 'far'\ntrapezoid_px = [60, 70, 1e9, 1e9]\noutput = 4\n",
           context());
  CHECK(norm(output(*fuzzy, {1, 0})) == 0);
  CHECK(norm(output(*fuzzy, {30, 0})) == doctest::Approx(1.5));
  CHECK(norm(output(*fuzzy, {55, 0})) == 0);  // no set covers it
  CHECK(norm(output(*fuzzy, {65, 0})) == doctest::Approx(4));
  CHECK_THROWS_AS(
      part(kParts.controller, "[p]\ntype = 'fuzzy'\n[[p.set]]\ntrapezoid_px = [3, 2, 1, 0]\n", context()),
      Error);
  CHECK_THROWS_AS(
      part(kParts.controller, "[p]\ntype = 'fuzzy'\n[[p.set]]\ntrapezoid_px = [1, 2]\n", context()), Error);
}

TEST_CASE("fuzzy direction rules") {
  const auto sign = part(kParts.controller, "p = { type = 'fuzzy', direction = 'axis-sign' }", context());
  CHECK(output(*sign, {300, -1}) == Vec2{-5, 5});
  const auto axis = part(kParts.controller, "p = { type = 'fuzzy', direction = 'per-axis' }", context());
  CHECK(output(*axis, {300, -10}) == Vec2{-5, 2.5});
}

TEST_CASE("the field is reversed for south-seeking cells") {
  const auto north = part(kParts.controller, "p = 'fuzzy'", context(1));
  const auto south = part(kParts.controller, "p = 'fuzzy'", context(-1));
  CHECK(output(*south, {200, 50}) == -1.0 * output(*north, {200, 50}));
}

TEST_CASE("no cells in view: feedback controllers command zero current") {
  for (const char* name : {"fuzzy", "proportional"}) {
    const auto c = part(kParts.controller, std::string("p = '") + name + "'", context());
    for (const double i : c->update(at({200, 100}, 0), {{0, 0}, 0, false}, 0.1).current) CHECK(i == 0);
  }
}

TEST_CASE("proportional: gain / (hold + delay), saturated, dead zone") {
  const auto p = part(kParts.controller, "p = { type = 'proportional', hold_frames = 2 }", context(1, 4));
  CHECK(output(*p, {-20, 0}).x == doctest::Approx(0.45 / 6 * 20));
  CHECK(output(*p, {-2000, 0}).x == doctest::Approx(5));
  const auto dead = part(kParts.controller, "p = { type = 'proportional', dead_zone_px = 8 }", context());
  CHECK(norm(output(*dead, {5, 5})) == 0);
  CHECK(norm(output(*dead, {9, 0})) > 0);
}

TEST_CASE("proportional, lead: the centroid is extrapolated by the delay and the reorientation time") {
  const double frame = 1.0 / 15;
  const auto p = part(kParts.controller, "p = { type = 'proportional', hold_frames = 2, lead = '100 ms' }",
                      context(1, 1));
  const double gain = 0.45 / 3;
  CHECK(output(*p, {-20, 0}).x == doctest::Approx(gain * 20));  // the velocity is unknown
  const double ahead = (0.1 + frame) / frame;                   // frames
  const Vec2 moving = output(*p, {-16, 2});                     // (4, 2) px per frame
  CHECK(moving.x == doctest::Approx(gain * (16 - 4 * ahead)));
  CHECK(moving.y == doctest::Approx(gain * (-2 - 2 * ahead)));
  p->update(at({300, 300}, 0), {{0, 0}, 0, false}, frame);  // out of view: resets the velocity
  CHECK(output(*p, {-10, 0}).x == doctest::Approx(gain * 10));
}

TEST_CASE("proportional, duty: full strength in every frame, the mean is the desired fraction") {
  // 186 um/s at 15 Hz and 1 um/px: 12.4 px per frame at full speed; gain 0.45 / 2
  const auto p =
      part(kParts.controller, "p = { type = 'proportional', actuation = 'duty', max_output = 7 }", context());
  const double wanted = 0.45 / 2 * 20 / 12.4;
  double sum = 0;
  const int n = 400;
  for (int i = 0; i < n; ++i) {
    const Vec2 d = output(*p, {-20, 0});
    CHECK(std::fabs(d.x) == doctest::Approx(7));
    sum += d.x / 7;
  }
  CHECK(std::fabs(sum / n - wanted) <= 2.0 / n);  // sigma-delta: error of at most the residual
}

TEST_CASE("manual: segments start on time and rotate without drift") {
  const auto m =
      part(kParts.controller,
           "[p]\ntype = 'manual'\nfield = [1e-3, 0]\n[[p.segment]]\nat = '1 s'\nfield = [-1e-3, 0]\n"
           "[[p.segment]]\nat = '2 s'\nrotating = 2e-3\nfrequency = '1 Hz'\n",
           context());
  for (int k = 0; k <= 45; ++k) {
    const Command c = m->update(at({0, 0}), {}, 1.0 / 15);
    INFO("frame ", k);
    if (k < 15) CHECK(c.current[0] == doctest::Approx(1e-3));
    if (k >= 15 && k < 30) CHECK(c.current[0] == doctest::Approx(-1e-3));
    if (k >= 30) {
      CHECK(std::hypot(c.current[0], c.current[1]) == doctest::Approx(2e-3));
      CHECK(
          c.current[0] ==
          doctest::Approx(2e-3 * std::cos(2 * 3.14159265358979 * (k - 30) / 15.0)).epsilon(1e-6).scale(2e-3));
    }
  }
  CHECK_THROWS_AS(
      part(kParts.controller, "[p]\ntype='manual'\n[[p.segment]]\nat=2\n[[p.segment]]\nat=1\n", context()),
      Error);
}

TEST_CASE("manual without an estimate: the scheduled field is that at the centre of the arena") {
  ControlContext c = context();
  const Document coils = parse_toml("[f]\ntype = 'rig'\n" + reference_coils("f.coil", {0, 90}), "test");
  c.field = kParts.field.resolve(Node(coils).child("f")).make({});
  const auto manual = part(kParts.controller, "[p]\ntype = 'manual'\nfield = [1e-3, -2e-3]\n", c);
  const auto none = part(kParts.estimator, "p = 'none'", c);
  const Command command = manual->update(none->update({}, {}), {}, 1.0 / 15);
  const Vec3 b = c.field->at({0, 0, 0}, command.current);
  CHECK(b.x == doctest::Approx(1e-3));
  CHECK(b.y == doctest::Approx(-2e-3));
}

TEST_CASE("proportional, duty: an estimate that is NaN does not change the state") {
  const auto shaken = part(kParts.controller, "p = { type = 'proportional', actuation = 'duty' }", context());
  const auto calm = part(kParts.controller, "p = { type = 'proportional', actuation = 'duty' }", context());
  CHECK(norm(output(*shaken, {std::nan(""), 0})) == 0);
  for (int k = 0; k < 30; ++k) {
    const Vec2 from_left{-200, 0};
    CHECK(output(*shaken, from_left).x == output(*calm, from_left).x);
  }
  CHECK(output(*shaken, {-200, 0}).x > 0);  // towards the setpoint
}

TEST_CASE("route: advances after the hold or the timeout, and finishes") {
  const auto r =
      part(kParts.reference,
           "p = { type = 'route', setpoints_px = [[329.5, 239.5], [319.5, 229.5]], hold_frames = 3, "
           "tolerance_px = 5 }",
           context());
  const auto ask = [&](Vec2 px, double t) {
    Estimate e = at(px);
    e.t = t;
    return r->update(e);
  };
  CHECK(ask({0, 0}, 0).position.x == doctest::Approx(10 * kPx));
  for (int k = 0; k < 2; ++k) CHECK(ask({9, 0}, 1).index == 0);
  CHECK(ask({0, 0}, 1).index == 0);  // left the tolerance: the count restarts
  for (int k = 0; k < 2; ++k) CHECK(ask({9, 0}, 1).index == 0);
  CHECK(ask({9, 0}, 1).index == 1);
  CHECK(ask({9, 0}, 1).position.y == doctest::Approx(10 * kPx));
  for (int k = 0; k < 3; ++k) ask({0, 9}, 2);
  CHECK(ask({0, 9}, 2).finished);
  const auto hurried =
      part(kParts.reference, "p = { type = 'route', setpoints_px = [[0, 0], [9, 9]], timeout = '2 s' }",
           context());
  Estimate e = at({0, 0});
  CHECK(hurried->update(e).index == 0);
  e.t = 2;
  CHECK(hurried->update(e).index == 1);
}

TEST_CASE("route: the first frame has the first setpoint, even if the swarm is there and need not stay") {
  const auto r = part(kParts.reference,
                      "p = { type = 'route', setpoints_px = [[0, 0], [9, 9]], hold_frames = 1 }", context());
  Estimate e = at({-319.5, 239.5});
  CHECK(r->update(e).index == 0);
  CHECK(r->update(e).index == 1);
}

TEST_CASE("estimators: mean of all cells, mean of those in view, last centroid with none in view") {
  Observation o;
  o.seen = {{0, 0, true}, {2e-6f, 0, true}, {10e-6f, 9e-6f, false}};
  const auto all = part(kParts.estimator, "p = 'mean'", context()),
             seen = part(kParts.estimator, "p = 'visible'", context());
  CHECK(all->update(o, {}).centroid.x == doctest::Approx(4e-6));
  CHECK(all->update(o, {}).visible == 3);
  const Estimate e = seen->update(o, {});
  CHECK(e.centroid.x == doctest::Approx(1e-6));
  CHECK(e.cov.xx == doctest::Approx(2e-12));
  for (auto& d : o.seen) d.in_view = false;
  o.t = 1;
  CHECK(seen->update(o, {}).visible == 0);
  CHECK(seen->update(o, {}).centroid.x == doctest::Approx(1e-6));
}
