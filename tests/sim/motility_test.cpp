#include <doctest/doctest.h>

#include "sim/motility/oxygen.h"
#include "tests/swarm.h"

using namespace faba;

TEST_CASE("Bessel functions against the standard library") {
  for (int i = 0; i < 4000; ++i) {
    const double x = i * 0.05;
    CHECK(std::fabs(bessel_j0(x) - std::cyl_bessel_j(0, x)) < 1e-7);
    CHECK(std::fabs(bessel_j1(x) - std::cyl_bessel_j(1, x)) < 1e-7);
  }
}

TEST_CASE("oxygen satisfies the diffusion equation, is 1 at the edge, and saturates the drop") {
  const double r_max = 1e-3, d = 2e-9;
  const OxygenProfile p(r_max, d);
  CHECK(p.concentration(r_max, 1) == doctest::Approx(1).epsilon(1e-6));
  CHECK(p.concentration(0, 2000) == doctest::Approx(1).epsilon(1e-6));
  for (const double t : {60.0, 150.0, 300.0})
    for (const double r : {0.2e-3, 0.5e-3, 0.8e-3}) {
      const double h = 1e-5, k = 0.5;
      const double rate = (p.concentration(r, t + k) - p.concentration(r, t - k)) / (2 * k);
      const double lap =
          (p.concentration(r + h, t) - 2 * p.concentration(r, t) + p.concentration(r - h, t)) / (h * h) +
          (p.concentration(r + h, t) - p.concentration(r - h, t)) / (2 * h * r);
      CHECK(rate ==
            doctest::Approx(d * lap).epsilon(2e-3));  // error of second differences: (h/R)^2 and (k/t)^2
      const double dose = (p.dose(r, t + k) - p.dose(r, t - k)) / (2 * k);
      CHECK(dose == doctest::Approx(p.concentration(r, t)).epsilon(1e-4));
    }
}

TEST_CASE("the interpolation table agrees with the series") {
  const OxygenProfile p(1e-3, 2e-9);
  float nodes[OxygenProfile::kNodes];
  for (const double t : {5.0, 33.0, 120.0, 400.0, 1e4}) {
    p.profile(t, nodes);
    for (int i = 0; i < OxygenProfile::kNodes; i += 4)
      CHECK(std::fabs(double(nodes[i]) - p.concentration(1e-3 * i / (OxygenProfile::kNodes - 1), t)) < 2e-3);
  }
}

TEST_CASE(
    "thesis law: speed factor 1/(1 + 0.00524 t), loss of response first at the edge, below 3 % after 700 s") {
  const auto scene = [](double exposure) {
    return "exposure = " + std::to_string(exposure) +
           "\nmotility = 'thesis'\nexclusion = { order = 'none' }\narena = { type = 'drop', radius_px = 1000 "
           "}\n"
           "[[swarm]]\ncount = 4000\nstart = 'uniform'\nmodel = { type = 'dipole', speed_sd = 0 }\n";
  };
  for (const double t : {0.0, 100.0, 350.0, 700.0}) {
    TestSwarm s(scene(t));
    CHECK(s.world().parts().motility->speed_factor(0) == doctest::Approx(1 / (1 + 0.00524 * t)));
    const double responding = double(s.world().responding()) / 4000;
    INFO("exposure ", t, " responding ", responding);
    if (t == 0) CHECK(responding == 1);
    if (t == 700) CHECK(responding < 0.03);
  }
  TestSwarm s(scene(450));
  const auto x = s.column("x"), y = s.column("y"), response = s.column("response");
  double edge = 0, edge_n = 0, middle = 0, middle_n = 0;
  for (std::size_t i = 0; i < x.size(); ++i) {
    const double r = std::hypot(double(x[i]), double(y[i])) / (1000 * 0.9164e-6);
    (r > 0.8 ? edge : middle) += response[i] != 0.0f;
    (r > 0.8 ? edge_n : middle_n) += 1;
  }
  CHECK(edge / edge_n < middle / middle_n - 0.1);
}

TEST_CASE("air exposure before the run has the same effect as during the run") {
  const std::string scene =
      "motility = 'thesis'\nexclusion = { order = 'none' }\ncamera = { rate = 1 }\nsimulation = { step = 1 "
      "}\n"
      "arena = { type = 'drop', radius_px = 800 }\n[[swarm]]\ncount = 500\nstart = 'uniform'\n"
      "model = { type = 'dipole', speed = 0, speed_sd = 0, translational_diffusion = 0 }\n";
  TestSwarm before("exposure = 400\n" + scene), during(scene);
  for (int i = 0; i < 400; ++i) during.world().step();
  const auto a = before.column("dose"), b = during.column("dose");
  for (std::size_t i = 0; i < a.size(); ++i)
    CHECK(double(b[i]) ==
          doctest::Approx(double(a[i])).epsilon(0.005));  // Euler in time with a step of 1 s: 0.5 s of 400
}
