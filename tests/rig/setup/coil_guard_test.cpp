// Logic of the guard, without a device or a clock ("Safety" of docs/guide/bench.md).
#include <doctest/doctest.h>

#include <cmath>
#include <limits>

#include "rig/setup/coil_guard.h"

using namespace faba;
using State = CoilGuard::State;
using Fault = CoilGuard::Fault;

namespace {

constexpr double kPeriod = 1.0 / 60;  // s

// A guard of two coils, a clock and a client.
struct Bench {
  explicit Bench(CoilGuard::Params p = {}, double max_current = 0.5, double max_rms = 0.5)
      : guard(p, {{max_current, max_rms}, {max_current, max_rms}}, kPeriod) {}

  void request(std::vector<double> current, double age = 0) {
    guard.heartbeat(now);
    guard.take({++number, now - age, now, current}, now);
  }
  // Advances the clock by `s` seconds, with heartbeats.
  void pass(double s) {
    for (const double until = now + s; now < until; now += 1e-3) {
      guard.heartbeat(now);
      guard.check(now);
    }
  }
  bool coils_off() const { return guard.current() == std::vector<double>{0, 0}; }

  CoilGuard guard;
  double now = 1000;  // s
  std::uint64_t number = 0;
};

}  // namespace

TEST_CASE("the guard starts disarmed, and no current flows until it is armed") {
  Bench b;
  CHECK(b.guard.state() == State::disarmed);
  b.request({0.1, 0.2});
  CHECK(b.coils_off());
  CHECK(b.guard.arm(b.now));
  CHECK(b.coils_off());
  b.request({0.1, 0.2});
  CHECK(b.guard.current() == std::vector<double>{0.1, 0.2});
  b.guard.disarm(b.now);
  CHECK(b.coils_off());
  CHECK(b.guard.state() == State::disarmed);
}

TEST_CASE(
    "every invalid current trips the guard with its fault; the fault is latched and all currents are zero") {
  const double nan = std::numeric_limits<double>::quiet_NaN(), inf = std::numeric_limits<double>::infinity();
  const struct {
    std::vector<double> current;
    Fault fault;
  } kBad[] = {{{nan, 0}, Fault::not_finite},     {{0.1, inf}, Fault::not_finite},
              {{0, -inf}, Fault::not_finite},    {{0.51, 0}, Fault::over_current},
              {{0, -0.51}, Fault::over_current}, {{100, 200}, Fault::over_current},  // mA in place of A
              {{0.1}, Fault::not_finite}};
  for (const auto& bad : kBad) {
    Bench b;
    b.guard.arm(b.now);
    b.request({0.3, -0.3});
    REQUIRE_FALSE(b.coils_off());
    b.request(bad.current);
    CHECK(b.guard.state() == State::tripped);
    CHECK(b.guard.fault() == bad.fault);
    CHECK_FALSE(b.guard.reason().empty());
    CHECK(b.coils_off());
    CHECK(b.guard.refused() == 1);
    b.request({0.1, 0.1});  // valid commands do not clear the fault
    CHECK(b.coils_off());
    CHECK_FALSE(b.guard.arm(b.now));  // nor does arming before a reset
    CHECK(b.coils_off());
    b.guard.reset();
    CHECK(b.guard.state() == State::disarmed);
    b.request({0.1, 0.1});
    CHECK(b.coils_off());
    CHECK(b.guard.arm(b.now));
    b.request({0.1, 0.1});
    CHECK_FALSE(b.coils_off());
  }
}

TEST_CASE("the maximum current and subnormal numbers are accepted") {
  Bench b;
  b.guard.arm(b.now);
  b.request({0.5, -0.5});
  CHECK(b.guard.current() == std::vector<double>{0.5, -0.5});
  b.request({1e-310, -1e-310});
  CHECK(b.guard.state() == State::armed);
}

TEST_CASE("command timeout: coils off within 100 ms, or within two frames if these are longer") {
  for (const double period : {1.0 / 60, 1.0 / 15, 0.5}) {
    const double within = std::max(0.1, 2 * period);
    CoilGuard guard({}, {{1, 1}}, period);
    double now = 5;
    guard.arm(now);
    const double one[] = {0.7};
    guard.take({1, now, now, one}, now);
    double flowed_until = now;
    for (; now < 5 + 3 * within; now += 1e-3) {
      guard.heartbeat(now);
      guard.check(now);
      if (guard.current()[0] != 0) flowed_until = now;
    }
    CHECK(flowed_until - 5 < within);
    CHECK(flowed_until - 5 > 1.5 * period);  // one late frame is not a fault
    CHECK(guard.fault() == Fault::command_timeout);
  }
}

TEST_CASE("heartbeat timeout: coils off although commands were recent") {
  Bench b;
  b.guard.arm(b.now);
  b.request({0.2, 0.2});
  b.guard.check(b.now + 0.069);
  CHECK(b.guard.state() == State::armed);
  b.guard.check(b.now + 0.071);
  CHECK(b.guard.fault() == Fault::heartbeat_timeout);
  CHECK(b.coils_off());
}

TEST_CASE("stale, repeated and out-of-order commands trip the guard") {
  Bench stale;
  stale.guard.arm(stale.now);
  stale.request({0.2, 0.2}, stale.guard.command_deadline() + 1e-3);
  CHECK(stale.guard.fault() == Fault::stale);
  Bench twice;
  twice.guard.arm(twice.now);
  twice.request({0.2, 0.2});
  --twice.number;
  twice.request({0.3, 0.3});
  CHECK(twice.guard.fault() == Fault::out_of_order);
  CHECK(twice.coils_off());
}

TEST_CASE("the slew rate limit applies from frame to frame, but not to zero current") {
  Bench b({.max_slew = 6.0});  // 0.1 A per frame
  b.guard.arm(b.now);
  b.request({0.1, 0});
  CHECK(b.guard.state() == State::armed);
  b.now += kPeriod;
  b.request({0.2, -0.1});
  CHECK(b.guard.state() == State::armed);
  b.request({0, 0});
  CHECK(b.guard.state() == State::armed);
  b.now += kPeriod;
  b.request({0.11, 0});
  CHECK(b.guard.fault() == Fault::over_slew);
}

TEST_CASE(
    "a client that applies the slew rate limit to run times does not exceed it, also after a long uptime") {
  Bench b({.max_slew = 1.0});
  const double start = 2.6e6;  // s, a month: resolution 5e-10 s
  b.now = start + 0.1;
  b.guard.arm(b.now);
  double current = 0, before = 0;
  for (int k = 0; k < 20; ++k) {
    b.now = start + 0.1 + k * kPeriod;
    const double t = b.now - start;
    if (k > 0) current += t - before;  // as Limits computes it
    before = t;
    b.request({current, 0});
    CHECK(b.guard.state() == State::armed);
  }
  b.now += kPeriod;
  b.request({current + kPeriod + 1e-6, 0});
  CHECK(b.guard.fault() == Fault::over_slew);
}

TEST_CASE("thermal limit: exponential average of the squared current over the thermal time") {
  // dH/dt = (I^2 - H) / tau from H = 0: the bound R^2 is reached after tau ln(I^2 / (I^2 - R^2)).
  const double tau = 2, rms = 0.3, current = 0.5;
  Bench b({.thermal_time = tau}, 0.5, rms);
  b.guard.arm(b.now);
  const double expected = tau * std::log(current * current / (current * current - rms * rms));
  const double start = b.now;
  while (b.guard.state() == State::armed && b.now < start + 10) {
    b.request({current, 0});
    b.pass(1e-2);
  }
  CHECK(b.guard.fault() == Fault::thermal_limit);
  CHECK(b.now - start == doctest::Approx(expected).epsilon(0.02));  // requests every 10 ms
  // A current just below the limit may flow for ever.
  Bench steady({.thermal_time = tau}, 0.5, rms);
  steady.guard.arm(steady.now);
  for (int i = 0; i < 2000; ++i) {
    steady.request({0.999 * rms, 0});
    steady.pass(1e-2);
  }
  CHECK(steady.guard.state() == State::armed);
  CHECK(steady.guard.heat() > 0.99);
  // Disarming and arming does not reset the thermal load.
  Bench toggled({.thermal_time = tau}, 0.5, rms);
  toggled.guard.arm(toggled.now);
  for (int i = 0; i < 1000 && toggled.guard.state() == State::armed; ++i) {
    toggled.request({current, 0});
    toggled.pass(1e-2);
    toggled.guard.disarm(toggled.now);
    toggled.guard.arm(toggled.now);
  }
  CHECK(toggled.guard.fault() == Fault::thermal_limit);
}

TEST_CASE("current mismatch: a fault after sense_samples samples, except while the current settles") {
  const CoilGuard::Params p{.sense_tolerance = 0.05, .sense_settling = 0.02, .sense_samples = 4};
  const double nan = std::nan("");
  Bench b(p);
  b.guard.arm(b.now);
  b.request({0.4, 0});
  for (int i = 0; i < 20; ++i) {  // rises to its value; the other coil has no input
    b.now += 1e-3;
    b.guard.sensed(std::vector<double>{0.02 * i, nan}, b.now);
  }
  CHECK(b.guard.state() == State::armed);
  for (int i = 0; i < 3; ++i) b.guard.sensed(std::vector<double>{0.2, nan}, b.now += 0.01);
  CHECK(b.guard.state() == State::armed);
  b.guard.sensed(std::vector<double>{0.4, nan}, b.now += 0.01);  // one good sample resets the count
  for (int i = 0; i < 3; ++i) b.guard.sensed(std::vector<double>{0.2, nan}, b.now += 0.01);
  CHECK(b.guard.state() == State::armed);
  b.guard.sensed(std::vector<double>{0.2, nan}, b.now += 0.01);
  CHECK(b.guard.fault() == Fault::current_mismatch);
  // Also without a request: a faulty device is detected before it is armed.
  Bench holds(p);
  for (int i = 0; i < 4; ++i) holds.guard.sensed(std::vector<double>{0, 0.3}, holds.now += 0.01);
  CHECK(holds.guard.fault() == Fault::current_mismatch);
  CHECK_FALSE(holds.guard.arm(holds.now));
}

TEST_CASE("the first fault is kept") {
  Bench b;
  b.guard.arm(b.now);
  b.request({9, 9});
  b.guard.fail(Fault::disconnected, "", b.now);
  CHECK(b.guard.fault() == Fault::over_current);
}
