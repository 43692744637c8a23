// The magnetic dipole model compared with closed forms (theory B3). Tolerances are four standard errors of
// the sample (one false alarm in 16 000), plus the documented bias of the integrator if it is larger.
#include <doctest/doctest.h>

#include <array>
#include <numbers>

#include "tests/swarm.h"

using namespace faba;

namespace {

constexpr double kPi = std::numbers::pi;
constexpr double kPerTesla = 1000;  // rad/(s T), m / f_r of the test cells

// v = 1e-4 m/s for all cells, D_t = 0, given D_r; the drag factor gives m / f_r = 1000 rad/(s T)
std::string swimmer(double d_r) {
  // f_r = factor 8 pi 1e-3 (1e-6)^3 = 1e-18 N m s; moment = 1e-15 A m^2
  return "type = 'dipole', moment = 1e-15, viscosity = 1e-3, radius = 1e-6, drag_factor = " +
         std::to_string(1e-18 / (8 * kPi * 1e-21)) +
         ", speed = 1e-4, speed_sd = 0, translational_diffusion = 0, " +
         "rotational_diffusion = " + std::to_string(d_r);
}
double field_for(double w_b) { return w_b / kPerTesla; }

}  // namespace

TEST_CASE("T3: stationary alignment is I1(kappa)/I0(kappa)") {
  // oracle: theory B3.1
  const std::array<std::array<double, 2>, 4> oracle{
      {{1, 0.4463899659}, {5, 0.893383137}, {10, 0.9485998260}, {20, 0.9746705079}}};
  for (const auto& [kappa, expected] : oracle) {
    const double d_r = 1, w = kappa * d_r, dt = std::min(0.1 / w, 0.004);
    TestSwarm t(free_space(swimmer(d_r), dt, 10000));
    t.world().command({field_for(w), 0});
    // From a uniform start the slowest mode decays at least as fast as e^{-D_r t}: after 8 / D_r it is below
    // 4e-4 of its size, a tenth of the standard error.
    for (int i = 0; i < int(8 / dt); ++i) t.world().step();
    const auto ux = t.column("ux");
    const Sample s = Sample::of(ux.size(), [&](std::size_t i) { return ux[i]; });
    INFO("kappa ", kappa, " mean cos ", s.mean, " expected ", expected, " s.e. ", s.standard_error);
    CHECK(std::fabs(s.mean - expected) < 4 * s.standard_error);
  }
}

TEST_CASE("T4: mean-square displacement of a free active Brownian particle") {
  // oracle: theory B3.4, v = D_r = 1, d = 2
  const double dt = 0.01;
  TestSwarm t(free_space(swimmer(1), dt, 40000));
  const std::array<std::array<double, 2>, 3> oracle{{{0.1, 0.009674836}, {1, 0.735758882}, {5, 8.013475894}}};
  int step = 0;
  for (const auto& [time, expected] : oracle) {
    for (; step < int(std::lround(time / dt)); ++step) t.world().step();
    const auto x = t.column("x"), y = t.column("y");
    const Sample s = Sample::of(x.size(), [&](std::size_t i) {
      const double px = double(x[i]) / 1e-4, py = double(y[i]) / 1e-4;
      return px * px + py * py;
    });
    INFO("t ", time, " msd ", s.mean, " expected ", expected);
    // motion along the mean of both headings loses D_r dt / 6 of the variance of one step: below 0.2 %
    // here
    CHECK(std::fabs(s.mean - expected) < 4 * s.standard_error + 0.002 * expected);
  }
}

TEST_CASE("T4: the effective diffusion constant decreases with the reversal rate") {
  // run-reverse at rate lambda: the heading decays with D_r + 2 lambda; D = v^2 / (2 (D_r + 2 lambda))
  const double dt = 0.01, lambda = 2, time = 20;
  TestSwarm t(free_space(swimmer(1) + ", reversal_rate = 2", dt, 20000));
  for (int i = 0; i < int(time / dt); ++i) t.world().step();
  const auto x = t.column("x");
  const Sample s = Sample::of(x.size(), [&](std::size_t i) { return double(x[i]) * double(x[i]) / 1e-8; });
  const double z = 1 + 2 * lambda, expected = (z * time - 1 + std::exp(-z * time)) / (z * z);
  CHECK(std::fabs(s.mean - expected) <
        4 * s.standard_error + 0.005 * expected);  // sign flips resolved to dt: 2 lambda dt^2
}

TEST_CASE("T5: a U-turn is pi v / w_B wide") {
  for (const double w : {5.0, 20.0}) {
    const double dt = 0.02 / w;
    TestSwarm t(free_space(swimmer(0), dt, 64));
    t.world().command({field_for(w), 0});
    for (int i = 0; i < int(14 / w / dt); ++i) t.world().step();  // now within e^-14 times a few of the field
    const State before = t.world().state();
    t.world().command({-field_for(w), 0});
    for (int i = 0; i < int(40 / w / dt); ++i) t.world().step();
    const auto y = t.column("y"), y0 = before.agents["y"], uy = before.agents["uy"];
    for (std::size_t i = 0; i < y.size(); ++i) {
      if (std::fabs(uy[i]) < 1e-7f) continue;  // exactly antiparallel in float: does not turn without noise
      const double width = std::fabs(double(y[i]) - double(y0[i])), expected = kPi * 1e-4 / w;
      CHECK(width == doctest::Approx(expected).epsilon(1e-3));
    }
  }
}

TEST_CASE("T5: mean time of a U-turn under noise") {
  // oracle: theory B3.3, w_B T from pi to |theta| < 1/sqrt(kappa), exact mean first passage
  const std::array<std::array<double, 2>, 3> oracle{{{5, 3.331893}, {20, 4.742214}, {100, 6.358172}}};
  for (const auto& [kappa, expected] : oracle) {
    const double d_r = 1, w = kappa * d_r, dt = 0.004 / w;
    TestSwarm t(free_space(swimmer(d_r), dt, 8000));
    t.alter([&](State& s) {
      for (float& u : s.agents["ux"]) u = -1;
      for (float& u : s.agents["uy"]) u = 0;
    });
    t.world().command({field_for(w), 0});
    const auto inside = float(std::cos(1 / std::sqrt(kappa)));
    std::vector<double> passed(8000, 0);
    std::size_t left = passed.size();
    for (int i = 1; left > 0 && i < 100000; ++i) {
      t.world().step();
      const auto ux = t.column("ux");
      for (std::size_t k = 0; k < passed.size(); ++k)
        if (passed[k] == 0 && ux[k] > inside) {
          passed[k] = i * 0.004;
          --left;
        }
    }
    REQUIRE(left == 0);
    const Sample s = Sample::of(passed.size(), [&](std::size_t i) { return passed[i]; });
    INFO("kappa ", kappa, " w T ", s.mean, " expected ", expected, " s.e. ", s.standard_error);
    CHECK(s.mean ==
          doctest::Approx(expected).epsilon(0.02));  // T5; monitoring at w dt = 0.004 adds about 0.6 % (D1)
  }
}

TEST_CASE("T6: mean rotation in a rotating field, below and above step-out") {
  // oracle: theory B3.6 (Stratonovich), kappa = 10, Omega and result in units of D_r
  const std::array<std::array<double, 2>, 4> oracle{
      {{5, 4.991297}, {9, 6.898902}, {12, 5.025426}, {20, 2.666121}}};
  for (const auto& [omega, expected] : oracle) {
    const double w = 10, dt = 0.002, settle = 5, time = 40;
    TestSwarm t(free_space(swimmer(1), dt, 1000));
    std::vector<double> turned(1000, 0);
    std::vector<float> px(1000), py(1000);
    const int steps = int((settle + time) / dt);
    for (int i = 0; i < steps; ++i) {
      const double phase = omega * (i + 0.5) * dt;  // mid-step: D1
      t.world().command({field_for(w) * std::cos(phase), field_for(w) * std::sin(phase)});
      const auto ux = t.column("ux"), uy = t.column("uy");
      std::copy(ux.begin(), ux.end(), px.begin());
      std::copy(uy.begin(), uy.end(), py.begin());
      t.world().step();
      if (i * dt < settle) continue;
      for (std::size_t k = 0; k < turned.size(); ++k)
        turned[k] += std::atan2(double(px[k] * uy[k] - py[k] * ux[k]), double(px[k] * ux[k] + py[k] * uy[k]));
    }
    const Sample s = Sample::of(turned.size(), [&](std::size_t k) { return turned[k] / time; });
    INFO("Omega ", omega, " rotation ", s.mean, " expected ", expected, " s.e. ", s.standard_error);
    CHECK(std::fabs(s.mean - expected) <
          4 * s.standard_error + 0.003 * expected);  // w dt = 0.02: bias below 0.3 %
  }
}

TEST_CASE("T8: a swarm held by a rotating field diffuses with v^2 D_r / (2 w_B^2), and a bias drifts it") {
  const double w = 30, omega = 5, dt = 0.004, v = 1e-4;
  const double lag = std::asin(omega / w), period = 2 * kPi / omega;
  const int per_period = int(std::lround(period / dt));
  const double fitted_dt = period / per_period;
  for (const double bias : {0.0, 0.1}) {
    TestSwarm t(free_space(swimmer(1), fitted_dt, 20000));
    std::vector<double> x0, y0;
    const int settle = 2, periods = 12;
    for (int i = 0; i < (settle + periods) * per_period; ++i) {
      if (i == settle * per_period) {
        const auto x = t.column("x"), y = t.column("y");
        x0.assign(x.begin(), x.end());
        y0.assign(y.begin(), y.end());
      }
      const double phase = omega * (i + 0.5) * fitted_dt;
      t.world().command({field_for(w) * (std::cos(phase) + bias), field_for(w) * std::sin(phase)});
      t.world().step();
    }
    const auto x = t.column("x"), y = t.column("y");
    const double time = periods * period;
    const Sample sx = Sample::of(x.size(), [&](std::size_t i) { return (double(x[i]) - x0[i]) / v; });
    const Sample sy = Sample::of(y.size(), [&](std::size_t i) { return (double(y[i]) - y0[i]) / v; });
    if (bias == 0.0) {
      // at both ends of the interval, the spread 1/kappa of headings on the circle of radius v / Omega adds
      // 2 / (kappa Omega^2) to the variance; this is not diffusion and is subtracted
      const double diffusion = ((sx.variance + sy.variance) / 2 - 1 / (30.0 * omega * omega)) / (2 * time);
      INFO("D ", diffusion, " expected ", 1 / (2 * w * w));
      CHECK(diffusion == doctest::Approx(1 / (2 * w * w)).epsilon(0.05));
    } else {
      const double speed = std::hypot(sx.mean, sy.mean) / time, angle = std::atan2(sy.mean, sx.mean);
      INFO("drift ", speed, " angle ", angle, " lag ", lag);
      CHECK(speed == doctest::Approx(bias / 2).epsilon(0.05));
      CHECK(std::fabs(angle - lag) < 0.05 * lag + 4 * sx.standard_error / (speed * time));
    }
  }
}

TEST_CASE("the integrator has the correct stationary state for any w dt") {
  // D1: error of 1 - <cos> at kappa = 200, "exact drift + OU noise": 0.4 % at w dt = 3
  for (const double wdt : {0.1, 1.0, 3.0}) {
    const double w = 200, dt = wdt / w;
    TestSwarm t(free_space(swimmer(1), dt, 40000));
    t.world().command({field_for(w), 0});
    for (int i = 0; i < std::max(400, int(20 / wdt)); ++i) t.world().step();
    const auto ux = t.column("ux");
    const Sample s = Sample::of(ux.size(), [&](std::size_t i) { return 1 - double(ux[i]); });
    const double expected = 1 - 0.9974968593;
    INFO("w dt ", wdt, " 1 - <cos> ", s.mean);
    CHECK(std::fabs(s.mean - expected) < 4 * s.standard_error + 0.004 * expected);
  }
}

TEST_CASE("south-seeking cells swim against the field, unresponsive cells are not affected") {
  TestSwarm t(free_space(swimmer(0.5), 0.01, 3000));
  t.alter([](State& s) {
    auto r = s.agents["response"];
    for (std::size_t i = 0; i < r.size(); ++i) r[i] = i < 1000 ? 1.0f : i < 2000 ? -1.0f : 0.0f;
  });
  t.world().command({field_for(50), 0});
  for (int i = 0; i < 1000; ++i) t.world().step();
  const auto ux = t.column("ux");
  const auto mean = [&](std::size_t from) {
    return Sample::of(1000, [&](std::size_t i) { return ux[from + i]; });
  };
  CHECK(mean(0).mean > 0.98);
  CHECK(mean(1000).mean < -0.98);
  CHECK(std::fabs(mean(2000).mean) < 4 * mean(2000).standard_error);
}

TEST_CASE("responsive cells start along `heading`, the others in random directions") {
  TestSwarm s(
      "[[swarm]]\ncount = 4000\nresponding = 0.5\nheading = '60 deg'\nmodel = 'dipole'\n"
      "[exclusion]\norder = 'none'\n");
  const auto ux = s.column("ux"), uy = s.column("uy"), response = s.column("response");
  Vec2 sum;
  std::size_t n = 0;
  for (std::size_t i = 0; i < ux.size(); ++i) {
    if (response[i] == 0) {
      sum = sum + Vec2{double(ux[i]), double(uy[i])};
      ++n;
      continue;
    }
    CHECK(ux[i] == doctest::Approx(0.5).epsilon(1e-6));
    CHECK(uy[i] == doctest::Approx(std::sqrt(0.75)).epsilon(1e-6));
  }
  REQUIRE(n > 1000);
  // The squared displacement of a random walk is exponential: a fraction e^-9 of seeds is above 3 sqrt(n).
  CHECK(norm(sum) < 3 * std::sqrt(double(n)));
}
