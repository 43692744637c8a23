// Laws of a swarm in a rotating field (theory B3.6 to B3.8) for the field that the controller commands: it is
// constant during a frame. Statistical tolerances are four standard errors.
#include <array>
#include <numbers>

#include "control/plant/rotation.h"
#include "tests/swarm.h"

#include <doctest/doctest.h>

using namespace faba;

namespace {

constexpr double kPi = std::numbers::pi;
constexpr double kPerTesla = 1000;  // rad/(s T), m / f_r of the test cells
constexpr double kSpeed = 1e-4;     // m/s
constexpr int kSteps = 4;           // per frame
constexpr double kFrame = 1.0 / 60;

std::string swimmer(double d_r) {
  // f_r = factor 8 pi 1e-3 (1e-6)^3 = 1e-18 N m s; moment = 1e-15 A m^2
  return fmt::format(
      "type = 'dipole', moment = 1e-15, viscosity = 1e-3, radius = 1e-6, drag_factor = {}, speed = {}, "
      "speed_sd = 0, translational_diffusion = 0, rotational_diffusion = {}",
      1e-18 / (8 * kPi * 1e-21), kSpeed, d_r);
}

/// Cells in free space in the rotating field, without a controller; 1 A makes 1 T.
struct Circling {
  TestSwarm t;
  ControlContext c;
  Rotation rotation;
  CirclingSwarm swarm;

  Circling(double w, double frequency, double d_r, int cells)
      : t(free_space(swimmer(d_r), kFrame / kSteps, cells)),
        c(context(t)),
        rotation({.rotating = w / kPerTesla, .frequency = frequency}, 1, c.motion, c),
        swarm(c.motion, rotation, 0.45, c) {}

  static ControlContext context(const TestSwarm& t) {
    ControlContext c = t.simulation.control();
    c.frame_period = kFrame;
    return c;
  }
  /// `bias`: T
  void frame(Vec2 bias = {}) {
    rotation.advance(kFrame);
    const Vec2 b = rotation.field() + bias;
    t.world().command({b.x, b.y});
    for (int i = 0; i < kSteps; ++i) t.world().step();
  }
  Vec2 cell(std::size_t i) { return {double(t.column("x")[i]), double(t.column("y")[i])}; }
  std::vector<Vec2> cells() {
    std::vector<Vec2> all;
    for (std::size_t i = 0; i < t.column("x").size(); ++i) all.push_back(cell(i));
    return all;
  }
};

std::string refusal(const RotationParams& p, const ControlContext& c) {
  try {
    Rotation(p, 1e-3, c.motion, c);
  } catch (const Error& e) {
    return e.what();
  }
  return {};
}

}  // namespace

TEST_CASE("rotating_hold: a locked cell swims on a circle of radius v / Omega about the computed centre") {
  for (const double frequency : {1.0, -1.0}) {
    Circling one(30, frequency, 0, 1);
    for (int k = 0; k < 120; ++k) one.frame();
    // The position is known now, and the next command is that of the next frame: age 0 before it.
    Vec2 mean, first;
    double largest = 0, sum = 0;
    std::vector<Vec2> seen;
    for (int k = 0; k < 60; ++k) {
      const Vec2 at = one.cell(0);
      seen.push_back(at);
      mean = mean + (1 / 60.0) * at;
      Rotation next = one.rotation;
      next.advance(kFrame);
      const Vec2 centre = one.swarm.centre(at, 0, 1, next);
      if (k == 0) first = centre;
      largest = std::max(largest, norm(centre - first));
      // An observation two frames old gives the same centre.
      if (k >= 2) {
        const Vec2 late = one.swarm.centre(seen[std::size_t(k) - 2], 2 * kFrame, 1, next);
        largest = std::max(largest, norm(late - first));
      }
      one.frame();
    }
    for (const Vec2 at : seen) sum += norm(at - mean) / 60;
    const double radius = kSpeed / (2 * kPi);
    INFO("radius ", sum, " expected ", radius, ", centre moves by ", largest);
    // The heading follows the steps of the field: its first harmonic is between sin(x) / x and 1, with x =
    // pi / 60, 1 - 5e-4, and higher harmonics move the cell by less than 1 / 60^2 of the radius.
    CHECK(sum == doctest::Approx(radius).epsilon(1e-3));
    CHECK(norm(first - mean) < 0.005 * radius);
    CHECK(largest < 0.005 * radius);
  }
}

TEST_CASE("rotating_hold: T8, a bias drifts the swarm with the commanded velocity") {
  for (const double w : {30.0, 12.0})
    for (const double frequency : {1.0, -1.0}) {
      Circling many(w, frequency, w / 60, 4000);
      const Vec2 wanted{0.04 * kSpeed, 0.02 * kSpeed};
      const Vec2 bias = many.swarm.bias(wanted, many.rotation);
      for (int k = 0; k < 120; ++k) many.frame(bias);
      const std::vector<Vec2> from = many.cells();
      const double time = 12;
      for (int k = 0; k < int(time * 60); ++k) many.frame(bias);
      const std::vector<Vec2> to = many.cells();
      const auto along = [&](auto component) {
        return Sample::of(to.size(), [&](std::size_t i) { return component(to[i] - from[i]) / time; });
      };
      const Sample x = along([](Vec2 d) { return d.x; }), y = along([](Vec2 d) { return d.y; });
      INFO("w ", w, " f ", frequency, ": ", x.mean / kSpeed, ", ", y.mean / kSpeed);
      const Vec2 drift{x.mean, y.mean};
      const double error = 4 * x.standard_error / norm(wanted);
      CHECK(norm(drift) == doctest::Approx(norm(wanted)).epsilon(0.05 + error));
      // 5 % of the length across, which is 2.9 degrees
      CHECK(std::fabs(drift.x * wanted.y - drift.y * wanted.x) < (0.05 + error) * dot(wanted, wanted));
    }
}

TEST_CASE("rotating_hold: T8, the guiding centres diffuse with v^2 D_r / (2 w_B^2) per axis") {
  const double w = 30, d_r = 1, time = 10;
  Circling many(w, 1, d_r, 8000);
  for (int k = 0; k < 120; ++k) many.frame();
  const std::vector<Vec2> from = many.cells();
  for (int k = 0; k < int(time * 60); ++k) many.frame();
  const std::vector<Vec2> to = many.cells();
  const Sample x = Sample::of(to.size(), [&](std::size_t i) { return (to[i].x - from[i].x) / kSpeed; });
  const Sample y = Sample::of(to.size(), [&](std::size_t i) { return (to[i].y - from[i].y) / kSpeed; });
  // The spread 1 / kappa of headings at both ends adds 2 / (kappa Omega^2), which is not diffusion; the lock
  // has the stiffness w cos(phi*) and the effective field.
  const double omega = 2 * kPi, kappa = w / d_r;
  const double diffusion = ((x.variance + y.variance) / 2 - 2 / (kappa * omega * omega)) / (2 * time);
  INFO("D ", diffusion, " expected ", d_r / (2 * w * w));
  // Relative standard error of a variance of 16 000 numbers: sqrt(2 / 16 000) = 1.1 %
  CHECK(diffusion == doctest::Approx(d_r / (2 * w * w)).epsilon(0.05));
}

TEST_CASE("rotating_hold: what the cells, the camera or the coils cannot follow is refused with the limit") {
  const TestSwarm t(free_space(swimmer(1), kFrame, 1));
  ControlContext c = t.simulation.control();
  c.max_current.assign(2, 0.1);
  // w_B = 20 rad/s steps out at 3.18 Hz; 0.9 of it is 2.86 Hz.
  CHECK(refusal({.rotating = 0.02, .frequency = 2.8}, c) == "");
  CHECK(refusal({.rotating = 0.02, .frequency = -2.8}, c) == "");
  const std::string cells = refusal({.rotating = 0.02, .frequency = 3}, c);
  CHECK(cells.find("controller.frequency: 3 Hz is too fast for the cells, which step out at 3.18 Hz") !=
        std::string::npos);
  CHECK(cells.find("between -2.86 and 2.86 Hz") != std::string::npos);
  c.motion.turning = 1e5;
  const std::string camera = refusal({.rotating = 0.02, .frequency = 8}, c);
  CHECK(camera.find("8 Hz is too fast for 60 frames/s") != std::string::npos);
  CHECK(camera.find("between -7.5 and 7.5 Hz") != std::string::npos);
  CHECK(refusal({.rotating = 0.02, .frequency = 7.5}, c) == "");
  // 0.1 T, less by the bias of 0.3 of the rotating field
  const std::string coils = refusal({.rotating = 0.09}, c);
  CHECK(coils.find("controller.rotating: 90 mT is too large for the coils; it must be at most 76.9 mT") !=
        std::string::npos);
  // A current of 20 mA at 5 Hz changes by 2 x 20 mA x sin(pi 5 / 60) = 10.35 mA per frame of 1/60 s: 0.621
  // A/s.
  c.max_slew = 0.63;
  CHECK(refusal({.rotating = 0.02, .frequency = 5}, c) == "");
  c.max_slew = 0.61;
  const std::string slow = refusal({.rotating = 0.02, .frequency = 5}, c);
  CHECK(slow.find("5 Hz in 20 mT is too fast for the coils, whose currents change by at most 0.61 A/s") !=
        std::string::npos);
  CHECK(slow.find("between -4.91 and 4.91 Hz") != std::string::npos);
  c.max_slew = {};
  c.motion.turning = 0;
  CHECK(refusal({.rotating = 0.02}, c).find("controller.turning: is 0") != std::string::npos);
  c.max_current.assign(2, 0.0);
  CHECK(refusal({}, c).find("field: the coils cannot rotate a field") != std::string::npos);
}

TEST_CASE("rotating_hold: the default frequency is one that cells and camera follow") {
  const TestSwarm t(free_space(swimmer(1), kFrame, 1));
  ControlContext c = t.simulation.control();
  const auto frequency = [&](double turning, double period) {
    c.motion.turning = turning;
    c.frame_period = period;
    return Rotation({.rotating = 1e-3}, 1e-3, c.motion, c).rate() / (2 * kPi);
  };
  CHECK(frequency(1.3e5, kFrame) == doctest::Approx(5));
  CHECK(frequency(1.3e5, 1.0 / 15) == doctest::Approx(15.0 / 8));
  CHECK(frequency(736, kFrame) == doctest::Approx(0.736 / 2 / (2 * kPi)));
}

namespace {

/// Mean of the cells of a simulation, px, averaged over the last `frames` frames.
struct Arrival {
  Vec2 mean_px;
  double spread_px = 0;
};
Arrival arrive(TestSwarm& t, int frames, int averaged) {
  Arrival a;
  const Frame f = t.simulation.frame();
  for (int k = 0; k < frames; ++k) {
    REQUIRE(run_cycle(t.simulation.loop()));
    if (k < frames - averaged) continue;
    const auto x = t.column("x"), y = t.column("y");
    const Sample sx = Sample::of(x.size(), [&](std::size_t i) { return x[i]; });
    const Sample sy = Sample::of(y.size(), [&](std::size_t i) { return y[i]; });
    a.mean_px = a.mean_px + (1.0 / averaged) * f.image_from_world({sx.mean, sy.mean});
    a.spread_px = std::sqrt((sx.variance + sy.variance) / 2) / f.m_per_px;
  }
  return a;
}

std::string scene(const std::string& model, const std::string& more) {
  return fmt::format(
      "duration = 30\narena = {{ type = 'drop', radius_px = 400 }}\n"
      "field = {{ type = 'uniform', earth = ['18 uT', '-9 uT'] }}\n{}\n"
      "[[swarm]]\ncount = 150\npolarity = 'south'\nmodel = {}\n"
      "start = {{ type = 'disc', centre_px = [260, 260], radius_px = 15 }}\n"
      "[reference]\ntype = 'hold'\nsetpoint_px = [340, 220]\n",
      more, model);
}

}  // namespace

TEST_CASE("rotating_hold: a swarm arrives and is held, with delay and an ambient field") {
  for (std::uint64_t seed = 1; seed <= 5; ++seed)
    for (const int delay : {0, 3}) {
      TestSwarm t(scene("{ type = 'dipole', preset = 'IT-1' }",
                        fmt::format("camera = {{ rate = 60, delay_frames = {} }}\ncontroller = "
                                    "'rotating_hold'",
                                    delay)),
                  seed);
      // 89 px are 82 um; at 28 um/s the swarm needs 2.9 s. Averaged over 24 frames, two revolutions
      const Arrival a = arrive(t, 480, 24);
      INFO("seed ", seed, " delay ", delay, ": ", a.mean_px.x, ", ", a.mean_px.y, ", spread ", a.spread_px);
      CHECK(norm(a.mean_px - Vec2{340, 220}) < 1);
      // From a disc of 15 px: 7.5 px per axis. Held: cells with half the moment diffuse four times faster,
      // 2 um^2/s, 6 px in 8 s; the drift of 82 um spreads by the speeds, 0.24 of it, at most 21 px
      CHECK(a.spread_px < 24);
    }
}

TEST_CASE("rotating_hold: the models whose cells follow the field at once arrive, too") {
  for (const std::string model :
       {"{ type = 'basic', max_speed = 8 }", "{ type = 'adapted', max_speed = 8 }"}) {
    TestSwarm t(scene(model, "camera = { rate = 15 }\ncontroller = 'rotating_hold'"));
    const Arrival a = arrive(t, 300, 8);
    INFO(model, ": ", a.mean_px.x, ", ", a.mean_px.y);
    // Noise of the mean of 150 cells, 8 px per iteration, and the gain of 0.45 per delay: about 3 px
    CHECK(norm(a.mean_px - Vec2{340, 220}) < 4);
  }
}

TEST_CASE("rotating_hold: circles that are wider than the settling band are noted") {
  const auto notes = [](const std::string& frequency) {
    TestSwarm t(scene(
        "{ type = 'dipole', preset = 'IT-1' }",
        "camera = { rate = 60 }\ncontroller = { type = 'rotating_hold', frequency = " + frequency + " }"));
    return t.simulation.controller().notes(t.simulation.reference().setpoints());
  };
  CHECK(notes("5").empty());  // 186 um/s / (10 pi rad/s) = 5.9 um, 6.5 px
  REQUIRE(notes("-1").size() == 1);
  CHECK(notes("-1")[0].find("a radius of 32.3 px (29.6 um) at 1 Hz") != std::string::npos);
}

TEST_CASE("rotating_hold: bits are equal after a checkpoint") {
  const std::string toml = scene("{ type = 'dipole', preset = 'IT-1' }",
                                 "camera = { rate = 60, delay_frames = 2 }\ncontroller = 'rotating_hold'");
  TestSwarm one(toml), other(toml, 1);
  arrive(one, 50, 1);
  Archive out;
  one.simulation.archive(out);
  arrive(one, 50, 1);
  Archive in(out.bytes());
  other.simulation.archive(in);
  arrive(other, 50, 1);
  CHECK(one.simulation.state_hash() == other.simulation.state_hash());
}
