// The published models: moments (theory A4, A5; T9), the controller experiment (A21; T20) and the effect of
// the update order (D4; T19).
#include <doctest/doctest.h>

#include <numeric>

#include "tests/swarm.h"

#include "app/scenario/read_scenario.h"

using namespace faba;

namespace {

constexpr double kPx = 0.9164e-6;

std::string pixels(const std::string& model, int count) { return free_space(model, 1.0 / 15, count); }

Scenario scene(const std::string& name, const std::vector<std::pair<std::string, std::string>>& set = {}) {
  Document d = read_toml(std::string(FABA_SCENES) + "/" + name + ".toml");
  for (const auto& [path, value] : set) d.set(path, value, "test");
  return read_scenario(d, builtin_parts());
}

struct Outcome {
  int reached = -1;  // first frame with d < 32 px
  double rms = 0, sigma_x = 0, sigma_y = 0;
};

// Runs the control loop of the scene and measures the figures of A21.
Outcome controlled(const Scenario& s, std::uint64_t seed) {
  struct Probe final : Sink {
    const World* world = nullptr;
    std::vector<double> d;
    double sx = 0, sy = 0;
    void take(const Tick& t) override {
      const auto x = world->state().agents["x"], y = world->state().agents["y"];
      const Sample mx = Sample::of(x.size(), [&](std::size_t i) { return double(x[i]) / kPx; });
      const Sample my = Sample::of(y.size(), [&](std::size_t i) { return double(y[i]) / kPx; });
      d.push_back(norm(Vec2{mx.mean, my.mean} - (1 / kPx) * t.target.position));
      sx = std::sqrt(mx.variance);
      sy = std::sqrt(my.variance);
    }
  } probe;
  Pool pool(1);
  Simulation sim(s, seed, pool);
  probe.world = &sim.world();
  sim.loop().sinks.push_back(&probe);
  run(sim.loop(), s.frames(), [] { return true; });
  Outcome o;
  for (std::size_t k = 0; k < probe.d.size(); ++k)
    if (probe.d[k] < 32) {
      o.reached = int(k);
      break;
    }
  double sum = 0;
  const std::size_t from = 2 * probe.d.size() / 3;
  for (std::size_t k = from; k < probe.d.size(); ++k) sum += probe.d[k] * probe.d[k];
  o.rms = std::sqrt(sum / double(probe.d.size() - from));
  o.sigma_x = probe.sx;
  o.sigma_y = probe.sy;
  return o;
}

}  // namespace

TEST_CASE("T9: Basic, mean, variance and correlation of the velocity") {
  const int n = 8;
  TestSwarm t(pixels("type = 'basic', max_speed = 8", 40000));
  t.world().command({3 * 23e-6, -2 * 23e-6});
  t.world().step();
  const auto vx = t.column("vx"), vy = t.column("vy");
  const Sample sx = Sample::of(vx.size(), [&](std::size_t i) { return vx[i]; });
  const Sample sy = Sample::of(vy.size(), [&](std::size_t i) { return vy[i]; });
  CHECK(std::fabs(sx.mean - 3) < 4 * sx.standard_error);
  CHECK(std::fabs(sy.mean + 2) < 4 * sy.standard_error);
  // variance n(n+1)/3; its standard error for a discrete uniform distribution, kurtosis below 1.8:
  // sqrt(0.8/N)
  CHECK(sx.variance == doctest::Approx(n * (n + 1) / 3.0).epsilon(4 * std::sqrt(0.8 / 40000)));
  for (const float v : vx) CHECK_MESSAGE((std::fabs(v - 3) < 8.01f), "bounded by n");
  // held for two iterations, then drawn again
  const std::vector<float> first(vx.begin(), vx.end());
  t.world().step();
  CHECK(std::equal(first.begin(), first.end(), t.column("vx").begin()));
  t.world().step();
  const auto later = t.column("vx");
  const Sample product = Sample::of(
      later.size(), [&](std::size_t i) { return (double(later[i]) - 3) * (double(first[i]) - 3); });
  CHECK(std::fabs(product.mean) < 4 * product.standard_error);
}

TEST_CASE("T9: Basic, the hold of two doubles the diffusion: Var = 2 n(n+1)/3 t") {
  TestSwarm t(pixels("type = 'basic', max_speed = 8", 20000));
  for (int i = 0; i < 200; ++i) t.world().step();
  const auto x = t.column("x");
  const Sample s = Sample::of(x.size(), [&](std::size_t i) { return double(x[i]) / kPx; });
  CHECK(std::fabs(s.mean) < 4 * s.standard_error);
  CHECK(s.variance == doctest::Approx(9600).epsilon(4 * std::sqrt(2.0 / 20000)));  // Gaussian: s.e. sqrt(2/N)
}

TEST_CASE("Adapted: innate speeds 0..n, drift n/2 independent of the field, upwards without a field") {
  TestSwarm t(pixels("type = 'adapted', max_speed = 9", 40000));
  const auto drift = [&] {
    const auto x = t.column("x");
    const std::vector<double> before(x.begin(), x.end());
    for (int i = 0; i < 2; ++i) t.world().step();
    const auto after = t.column("x");
    return Sample::of(before.size(),
                      [&](std::size_t i) { return (double(after[i]) - before[i]) / (2 * kPx); });
  };
  for (const double units :
       {100.0, 1000.0}) {  // strong fields: the direction is not affected by the Earth's field of one unit
    t.world().command({units * 23e-6, 0});
    const Sample s = drift();
    CHECK(std::fabs(s.mean - 4.5) < 4 * s.standard_error + 0.001);
  }
  const auto speed = t.column("speed");
  const auto still = std::size_t(std::count(speed.begin(), speed.end(), 0.0f));
  CHECK(double(still) / 40000 == doctest::Approx(0.1).epsilon(4 * std::sqrt(0.9 / 0.1 / 40000)));
  t.world().command({0, 0});
  t.world().step();
  t.world().step();
  const auto vy = t.column("vy");
  const Sample up = Sample::of(vy.size(), [&](std::size_t i) { return vy[i]; });
  CHECK(std::fabs(up.mean - 4.5) < 4 * up.standard_error);
}

TEST_CASE("T20: the controller experiment of the thesis over 20 seeds (A21)") {
  struct Range {
    const char* name;
    double rms_low, rms_high, sx_low, sx_high;
  };
  for (const Range& r :
       {Range{"thesis-basic", 1.5, 3, 115, 150}, Range{"thesis-adapted", 2.8, 4.5, 170, 205}}) {
    const Scenario s = scene(r.name);
    for (std::uint64_t seed = 1; seed <= 20; ++seed) {
      const Outcome o = controlled(s, seed);
      INFO(r.name, " seed ", seed, ": reached ", o.reached, " rms ", o.rms, " sigma ", o.sigma_x, " ",
           o.sigma_y);
      CHECK(o.reached >= 55);
      CHECK(o.reached <= 75);
      CHECK(o.rms >= r.rms_low);
      CHECK(o.rms <= r.rms_high);
      CHECK(o.sigma_x >= r.sx_low);
      CHECK(o.sigma_x <= r.sx_high);
      CHECK(o.sigma_y >= 125);
      CHECK(o.sigma_y <= 155);
    }
  }
}

TEST_CASE("the corner experiment: the swarm stops in the corner after 3.5 to 4.6 s (A21)") {
  const Scenario s = scene("corner");
  for (std::uint64_t seed = 1; seed <= 20; ++seed) {
    Pool pool(1);
    Simulation sim(s, seed, pool);
    struct Probe final : Sink {
      const World* world = nullptr;
      std::vector<Vec2> at;
      void take(const Tick&) override {
        const auto x = world->state().agents["x"], y = world->state().agents["y"];
        at.push_back({std::accumulate(x.begin(), x.end(), 0.0) / double(x.size()) / kPx,
                      std::accumulate(y.begin(), y.end(), 0.0) / double(y.size()) / kPx});
      }
    } probe;
    probe.world = &sim.world();
    sim.loop().sinks.push_back(&probe);
    run(sim.loop(), s.frames(), [] { return true; });
    const Vec2 final = probe.at.back();
    CHECK(final.x < -250);  // in the corner, up to the accumulation along the upper wall
    CHECK(final.y > 200);
    std::size_t k = 0;
    while (norm(probe.at[k] - final) > 30) ++k;
    INFO("seed ", seed, ": ", double(k) / 15, " s");
    CHECK(double(k) / 15 >= 3.5);
    CHECK(double(k) / 15 <= 4.6);
  }
}

TEST_CASE("T19: two-phase and published order give the same statistics at low density") {
  // Paired over 20 seeds: the mean difference of each figure is below four standard errors.
  const Scenario two = scene("thesis-basic"),
                 published = scene("thesis-basic", {{"exclusion.order", "published"}});
  std::vector<Outcome> a, b;
  for (std::uint64_t seed = 1; seed <= 20; ++seed) {
    a.push_back(controlled(two, seed));
    b.push_back(controlled(published, seed));
  }
  for (double Outcome::*figure : {&Outcome::rms, &Outcome::sigma_x, &Outcome::sigma_y}) {
    const Sample s = Sample::of(a.size(), [&](std::size_t i) { return a[i].*figure - b[i].*figure; });
    CHECK(std::fabs(s.mean) < 4 * s.standard_error);
  }
}
