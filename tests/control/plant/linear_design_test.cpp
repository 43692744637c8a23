// Laws of the linear-quadratic regulator.
#include <doctest/doctest.h>

#include <cmath>

#include "control/plant/linear_design.h"

using namespace faba;

namespace {
constexpr double kPeriod = 1.0 / 60, kPi = 3.14159265358979323846;
}

TEST_CASE("lqr: the gain of an integrator has a closed form") {
  // p(k+1) = p(k) + b a(k): the Riccati equation P = q + P / (1 + b^2 P) is quadratic.
  for (const double gain : {1e-5, 1e-4, 1e-3})
    for (const double error : {1e-6, 1e-5}) {
      const LqrDesign d = lqr_design({.immediate = true, .gain = gain}, kPeriod, {.error = error});
      const double b = gain * kPeriod, q = 1 / (error * error);
      const double p = q / 2 + std::sqrt(q * q / 4 + q / (b * b));
      CHECK(d.position == doctest::Approx(b * p / (1 + b * b * p)).epsilon(1e-9));
      CHECK(d.velocity == 0);
      REQUIRE(d.poles.size() == 1);
      CHECK(d.poles[0].real() == doctest::Approx(1 - b * d.position).epsilon(1e-9));
      CHECK(std::abs(d.poles[0]) < 1);
    }
}

TEST_CASE("lqr: a double integrator approaches the closed form of continuous time") {
  // For d2x/dt2 = g a the optimal gains are 1 / error and sqrt(2 / (g error)), with a damping of 1 / sqrt(2).
  // A frame is h of the closed loop's time scale; the gains differ from those of continuous time by about h.
  const double g = 2e-3, error = 1e-4, period = 1e-4;
  const double omega = std::sqrt(g / error);
  const LqrDesign d = lqr_design({.gain = g, .rate = 0}, period, {.error = error});
  CHECK(d.position == doctest::Approx(1 / error).epsilon(2 * omega * period));
  CHECK(d.velocity == doctest::Approx(std::sqrt(2 / (g * error))).epsilon(2 * omega * period));
  const Margins m = margins_of(d, 0);
  // Its return difference is at least 1 at every frequency: 60 degrees of phase, and any higher gain. This
  // design without weight of the velocity has 65.5 degrees.
  CHECK(m.phase > kPi / 3);
  CHECK(m.phase * 180 / kPi == doctest::Approx(65.5).epsilon(0.02));
  CHECK(m.gain > 50);
}

TEST_CASE("lqr: the closed loop is stable, and its poles are those of the gains") {
  for (const double rate : {0.0, 0.5, 5.0})
    for (const std::optional<double> integral : {std::optional<double>{}, std::optional<double>{2.0}}) {
      const LinearPlant plant{.gain = 1.4e-3, .rate = rate};
      const LqrDesign d = lqr_design(plant, kPeriod, {.error = 2e-6, .integral_time = integral});
      for (const auto& pole : d.poles) CHECK(std::abs(pole) < 1);
      // Simulated, the error vanishes.
      const DiscretePlant x = discrete(plant, kPeriod);
      double p = 1e-5, v = 0, z = 0;
      for (int k = 0; k < 3000; ++k) {
        const double a = -(d.position * p + d.velocity * v + d.integral * z);
        z += kPeriod * p;
        p += x.position_by_velocity * v + x.position_by_command * a;
        v = x.velocity_by_velocity * v + x.velocity_by_command * a;
      }
      CHECK(std::fabs(p) < 1e-9);
      if (integral) CHECK(d.integral > 0);
    }
}

TEST_CASE("lqr: a delay of its delay margin makes the loop unstable, less does not") {
  const LinearPlant plant{.gain = 1.4e-3, .rate = 0.5};
  const LqrDesign d = lqr_design(plant, kPeriod, {.error = 2e-6});
  const DiscretePlant x = discrete(plant, kPeriod);
  for (const int delay : {0, 2}) {
    const Margins m = margins_of(d, delay);
    CHECK(m.gain > 1);
    // The loop with `extra` more frames of delay than the predictor knows.
    const auto grows = [&](int extra) {
      std::vector<double> given(std::size_t(delay + extra) + 1, 0.0);
      std::vector<Vec2> states(std::size_t(delay + extra) + 1, Vec2{1e-6, 0});
      double p = 1e-6, v = 0, late = 0;
      for (int k = 0; k < 4000; ++k) {
        states.push_back({p, v});
        const Vec2 seen = states[states.size() - 1 - std::size_t(delay + extra)];
        double q = seen.x, w = seen.y;
        for (int j = delay; j > 0; --j) {
          const double a = given[given.size() - std::size_t(j)];
          q += x.position_by_velocity * w + x.position_by_command * a;
          w = x.velocity_by_velocity * w + x.velocity_by_command * a;
        }
        const double a = -(d.position * q + d.velocity * w);
        given.push_back(a);
        p += x.position_by_velocity * v + x.position_by_command * a;
        v = x.velocity_by_velocity * v + x.velocity_by_command * a;
        if (k > 3000) late = std::max(late, std::fabs(p));
      }
      return late > 1e-6;
    };
    const int margin = int(m.delay / kPeriod);
    CHECK_FALSE(grows(margin));
    CHECK(grows(margin + 1));
  }
}
