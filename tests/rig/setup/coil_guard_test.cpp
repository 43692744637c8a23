// The guard's rules, without a device or a clock ("Safety" of docs/guide/bench.md).
#include <doctest/doctest.h>

#include <cmath>
#include <limits>

#include "rig/setup/coil_guard.h"

using namespace faba;
using State = CoilGuard::State;
using Fault = CoilGuard::Fault;

namespace {

constexpr double kPeriod = 1.0 / 60;  // s

// A guard of two coils with a clock, and a program that speaks to it.
struct Bench {
  explicit Bench(CoilGuard::Params p = {}, double max_current = 0.5, double max_rms = 0.5)
      : guard(p, {{max_current, max_rms}, {max_current, max_rms}}, kPeriod) {}

  void ask(std::vector<double> current, double age = 0) {
    guard.beat(now);
    guard.take({++number, now - age, now, current}, now);
  }
  // So much time goes by, with signs of life.
  void pass(double s) {
    for (const double until = now + s; now < until; now += 1e-3) {
      guard.beat(now);
      guard.look(now);
    }
  }
  bool at_rest() const { return guard.current() == std::vector<double>{0, 0}; }

  CoilGuard guard;
  double now = 1000;  // s
  std::uint64_t number = 0;
};

}  // namespace

TEST_CASE("it begins disarmed, and nothing flows until it is armed by hand") {
  Bench b;
  CHECK(b.guard.state() == State::disarmed);
  b.ask({0.1, 0.2});
  CHECK(b.at_rest());
  CHECK(b.guard.arm(b.now));
  CHECK(b.at_rest());
  b.ask({0.1, 0.2});
  CHECK(b.guard.current() == std::vector<double>{0.1, 0.2});
  b.guard.disarm(b.now);
  CHECK(b.at_rest());
  CHECK(b.guard.state() == State::disarmed);
}

TEST_CASE("what no coil may get: each is a fault, named, that takes all current away and stays") {
  const double nan = std::numeric_limits<double>::quiet_NaN(), inf = std::numeric_limits<double>::infinity();
  const struct {
    std::vector<double> current;
    Fault fault;
  } kBad[] = {{{nan, 0}, Fault::not_finite},     {{0.1, inf}, Fault::not_finite},
              {{0, -inf}, Fault::not_finite},    {{0.51, 0}, Fault::over_current},
              {{0, -0.51}, Fault::over_current}, {{100, 200}, Fault::over_current},  // mA taken for A
              {{0.1}, Fault::not_finite}};
  for (const auto& bad : kBad) {
    Bench b;
    b.guard.arm(b.now);
    b.ask({0.3, -0.3});
    REQUIRE_FALSE(b.at_rest());
    b.ask(bad.current);
    CHECK(b.guard.state() == State::faulted);
    CHECK(b.guard.fault() == bad.fault);
    CHECK_FALSE(b.guard.reason().empty());
    CHECK(b.at_rest());
    CHECK(b.guard.refused() == 1);
    b.ask({0.1, 0.1});  // good ones do not help
    CHECK(b.at_rest());
    CHECK_FALSE(b.guard.arm(b.now));  // nor does arming, before the fault was seen to
    CHECK(b.at_rest());
    b.guard.reset();
    CHECK(b.guard.state() == State::disarmed);
    b.ask({0.1, 0.1});
    CHECK(b.at_rest());
    CHECK(b.guard.arm(b.now));
    b.ask({0.1, 0.1});
    CHECK_FALSE(b.at_rest());
  }
}

TEST_CASE("the largest current itself is allowed, and numbers too small to be currents do no harm") {
  Bench b;
  b.guard.arm(b.now);
  b.ask({0.5, -0.5});
  CHECK(b.guard.current() == std::vector<double>{0.5, -0.5});
  b.ask({1e-310, -1e-310});
  CHECK(b.guard.state() == State::armed);
}

TEST_CASE("no fresh command in time: at rest within 100 ms, or within two frames when those are longer") {
  for (const double period : {1.0 / 60, 1.0 / 15, 0.5}) {
    const double within = std::max(0.1, 2 * period);
    CoilGuard guard({}, {{1, 1}}, period);
    double now = 5;
    guard.arm(now);
    const double one[] = {0.7};
    guard.take({1, now, now, one}, now);
    double flowed_until = now;
    for (; now < 5 + 3 * within; now += 1e-3) {
      guard.beat(now);
      guard.look(now);
      if (guard.current()[0] != 0) flowed_until = now;
    }
    CHECK(flowed_until - 5 < within);
    CHECK(flowed_until - 5 > 1.5 * period);  // one frame that is a little late is no fault
    CHECK(guard.fault() == Fault::late);
  }
}

TEST_CASE("no sign of life: at rest though commands were fresh") {
  Bench b;
  b.guard.arm(b.now);
  b.ask({0.2, 0.2});
  b.guard.look(b.now + 0.069);
  CHECK(b.guard.state() == State::armed);
  b.guard.look(b.now + 0.071);
  CHECK(b.guard.fault() == Fault::silent);
  CHECK(b.at_rest());
}

TEST_CASE("a command that is old when it comes, comes twice, or after a later one is refused") {
  Bench stale;
  stale.guard.arm(stale.now);
  stale.ask({0.2, 0.2}, stale.guard.command_deadline() + 1e-3);
  CHECK(stale.guard.fault() == Fault::stale);
  Bench twice;
  twice.guard.arm(twice.now);
  twice.ask({0.2, 0.2});
  --twice.number;
  twice.ask({0.3, 0.3});
  CHECK(twice.guard.fault() == Fault::disorder);
  CHECK(twice.at_rest());
}

TEST_CASE("changes are as slow as allowed, from frame to frame, but to zero it may go at once") {
  Bench b({.max_slew = 6.0});  // 0.1 A a frame
  b.guard.arm(b.now);
  b.ask({0.1, 0});
  CHECK(b.guard.state() == State::armed);
  b.now += kPeriod;
  b.ask({0.2, -0.1});
  CHECK(b.guard.state() == State::armed);
  b.ask({0, 0});
  CHECK(b.guard.state() == State::armed);
  b.now += kPeriod;
  b.ask({0.11, 0});
  CHECK(b.guard.fault() == Fault::over_slew);
}

TEST_CASE("who keeps to the slew limit by times since the run began is within it, however old the clock is") {
  Bench b({.max_slew = 1.0});
  const double began = 2.6e6;  // s, a month: its last bit is 5e-10 s
  b.now = began + 0.1;
  b.guard.arm(b.now);
  double current = 0, before = 0;
  for (int k = 0; k < 20; ++k) {
    b.now = began + 0.1 + k * kPeriod;
    const double t = b.now - began;
    if (k > 0) current += t - before;  // as Limits reckons
    before = t;
    b.ask({current, 0});
    CHECK(b.guard.state() == State::armed);
  }
  b.now += kPeriod;
  b.ask({current + kPeriod + 1e-6, 0});
  CHECK(b.guard.fault() == Fault::over_slew);
}

TEST_CASE("heat: the mean square of the current over the thermal time, as an average in time must be") {
  // dH/dt = (I^2 - H) / tau from H = 0: the bound R^2 is reached after tau ln(I^2 / (I^2 - R^2)).
  const double tau = 2, rms = 0.3, current = 0.5;
  Bench b({.thermal_time = tau}, 0.5, rms);
  b.guard.arm(b.now);
  const double expected = tau * std::log(current * current / (current * current - rms * rms));
  const double began = b.now;
  while (b.guard.state() == State::armed && b.now < began + 10) {
    b.ask({current, 0});
    b.pass(1e-2);
  }
  CHECK(b.guard.fault() == Fault::too_warm);
  CHECK(b.now - began == doctest::Approx(expected).epsilon(0.02));  // asked every 10 ms
  // What the coil bears it bears without end.
  Bench steady({.thermal_time = tau}, 0.5, rms);
  steady.guard.arm(steady.now);
  for (int i = 0; i < 2000; ++i) {
    steady.ask({0.999 * rms, 0});
    steady.pass(1e-2);
  }
  CHECK(steady.guard.state() == State::armed);
  CHECK(steady.guard.heat() > 0.99);
  // Turning it off and on does not cool it.
  Bench sly({.thermal_time = tau}, 0.5, rms);
  sly.guard.arm(sly.now);
  for (int i = 0; i < 1000 && sly.guard.state() == State::armed; ++i) {
    sly.ask({current, 0});
    sly.pass(1e-2);
    sly.guard.disarm(sly.now);
    sly.guard.arm(sly.now);
  }
  CHECK(sly.guard.fault() == Fault::too_warm);
}

TEST_CASE("a sensed current that is not the one asked for: a fault after so many samples, lag excepted") {
  const CoilGuard::Params p{.sense_tolerance = 0.05, .sense_settling = 0.02, .sense_samples = 4};
  const double nan = std::nan("");
  Bench b(p);
  b.guard.arm(b.now);
  b.ask({0.4, 0});
  for (int i = 0; i < 20; ++i) {  // it still rises, then is there; the other coil tells nothing
    b.now += 1e-3;
    b.guard.sensed(std::vector<double>{0.02 * i, nan}, b.now);
  }
  CHECK(b.guard.state() == State::armed);
  for (int i = 0; i < 3; ++i) b.guard.sensed(std::vector<double>{0.2, nan}, b.now += 0.01);
  CHECK(b.guard.state() == State::armed);
  b.guard.sensed(std::vector<double>{0.4, nan}, b.now += 0.01);  // one good one begins the count anew
  for (int i = 0; i < 3; ++i) b.guard.sensed(std::vector<double>{0.2, nan}, b.now += 0.01);
  CHECK(b.guard.state() == State::armed);
  b.guard.sensed(std::vector<double>{0.2, nan}, b.now += 0.01);
  CHECK(b.guard.fault() == Fault::sensed);
  // Also while nothing is asked for: a device that does not obey is known before it is armed.
  Bench holds(p);
  for (int i = 0; i < 4; ++i) holds.guard.sensed(std::vector<double>{0, 0.3}, holds.now += 0.01);
  CHECK(holds.guard.fault() == Fault::sensed);
  CHECK_FALSE(holds.guard.arm(holds.now));
}

TEST_CASE("the first reason is the one that is told") {
  Bench b;
  b.guard.arm(b.now);
  b.ask({9, 9});
  b.guard.fail(Fault::closed, "", b.now);
  CHECK(b.guard.fault() == Fault::over_current);
}
