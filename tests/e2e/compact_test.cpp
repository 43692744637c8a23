// Controller `compact` in its scene: what walls and traps can do to the size of a swarm, and what a uniform
// field cannot.
#include <cmath>

#include "study/data/series.h"
#include "tests/e2e/program.h"

using namespace faba;

namespace {

// RMS radius of the swarm, px, and distance of its mean to the setpoint, for each frame of the scene.
struct Course {
  std::vector<double> radius, distance;
  double first() const { return radius.front(); }
};
Course course(const std::string& settings) {
  const TestFolder f;
  const Called c = faba_in(f.path, "run '" FABA_SCENES
                                   "/compact.toml' --seed 1 --out run --quiet --set record.video=false "
                                   "--set record.tracks=false " +
                                       settings);
  REQUIRE_MESSAGE(c.exit == 0, c.err);
  const Series s = read_series(f.path / "run/series.csv");
  const auto distance = s.column("distance_px");
  return {swarm_columns(s).rms_radius, {distance.begin(), distance.end()}};
}
double mean_after(const std::vector<double>& v, double fraction) {
  double sum = 0;
  std::size_t n = 0;
  for (auto k = std::size_t(fraction * double(v.size())); k < v.size(); ++k, ++n) sum += v[k];
  return sum / double(n);
}

}  // namespace

TEST_CASE(
    "compact: the edge reduces the RMS radius to a third, and the compact swarm is moved to the centre") {
  const Course c = course("");
  // A uniform disc has an RMS radius of R / sqrt 2; 300 cells determine it within 1 / (2 sqrt 300) = 3 %.
  CHECK(c.first() == doctest::Approx(340 / std::sqrt(2.0)).epsilon(0.06));
  const auto least = std::min_element(c.radius.begin(), c.radius.end());
  CHECK(*least <= c.first() / 3);
  CHECK(least - c.radius.begin() < 60 * 60);
  // Moved by L, the spread of the speeds, 45 / 186 of the mean (theory B4), adds sd(v) / v L along the way
  // (F1 b). Four standard errors of a standard deviation of 300 cells are 16 %; cells that turn late add a
  // few percent.
  const double added = 45.0 / 186 * 330, final_radius = mean_after(c.radius, 0.8);
  const double loss = std::sqrt(final_radius * final_radius - *least * *least);
  MESSAGE("RMS radius px: ", c.first(), " at first, ", *least, " at the edge, ", final_radius,
          " at the setpoint");
  CHECK(loss > 0.8 * added);
  CHECK(loss < 1.2 * added);
  // The mean circles with v / Omega = 186 um/s / (2 pi 5 Hz) = 6.5 px; its centre is held to a pixel.
  CHECK(mean_after(c.distance, 0.8) < 7.5);
}

TEST_CASE("compact: a four-coil trap reaches its equilibrium, and moves the swarm without a loss") {
  // Without exclusion, as in the law (B3.9): cells that exclude each other block each other in the middle.
  // Equal cells.
  const std::string cells =
      "--set exclusion.order=none --set "
      "'swarm[0].model={type=\"dipole\",preset=\"IT-1\",moment_spread=0,speed_sd=\"0 m/s\"}' "
      "--set controller.gather=trap --set controller.transport=trap ";
  // v f_r / (m g) per axis: f_r = 8 pi eta R^3 with the values of B2, and the gradient that `faba field null`
  // states.
  const TestFolder f;
  const double g = std::abs(
      json_in(f.path, "field null '" FABA_SCENES "/../rigs/near-four-coils.toml'")["eigenvalues_t_per_m"][0]
          .get<double>());
  const double per_axis = 186e-6 * 7.6723e-21 / (1e-15 * g), px = 0.9164e-6;
  const double equilibrium = std::sqrt(2 * per_axis) / px;
  const Course held = course(cells + "--set reference.setpoint_px='[359.5,359.5]'");
  MESSAGE("RMS radius px: ", mean_after(held.radius, 0.3), ", equilibrium ", equilibrium);
  // 10 %: the goal of the scene; 300 cells have a standard error of 3 %, less in the mean over 40 s.
  CHECK(mean_after(held.radius, 0.3) == doctest::Approx(equilibrium).epsilon(0.1));
  // Over half of the drop: from its centre to 170 px and back is within the linear range; the zero arrives
  // after 170 px / (0.2 * 203 px/s) = 4 s.
  const Course moved = course(cells + "--set reference.setpoint_px='[189.5,359.5]'");
  // Four standard errors of the mean of 300 cells, equilibrium / sqrt 300, and of their RMS radius, 2.9 %
  // each.
  CHECK(mean_after(moved.distance, 0.5) < 4 * equilibrium / std::sqrt(300.0));
  CHECK(mean_after(moved.radius, 0.5) < 1.12 * equilibrium);
}

TEST_CASE("compact: without walls a uniform field cannot make a swarm smaller (F1)") {
  // A disc of 100 px in a drop of 5000 px: no cell reaches the edge in 10 s, 2030 px.
  const Course c = course(
      "--set arena.radius_px=5000 --set duration='\"10 s\"' --set "
      "'swarm[0].start={type=\"disc\",radius_px=100}' "
      "--set controller.direction=0 ");
  // Before the cells have turned they swim in all directions, which makes the swarm larger, too.
  CHECK(*std::min_element(c.radius.begin(), c.radius.end()) >= 0.99 * c.first());
}

TEST_CASE("compact: a run states which zeros of its trap the coils cannot produce") {
  const TestFolder f;
  const auto notes = [&](const std::string& settings) {
    const Called c = faba_in(f.path, "run '" FABA_SCENES
                                     "/compact.toml' --seed 1 --out run --force --set duration=0.1 --set "
                                     "record.video=false " +
                                         settings);
    REQUIRE_MESSAGE(c.exit == 0, c.err);
    return c.err;
  };
  const std::string trap = "--set controller.gather=trap --set controller.transport=trap ",
                    weak = "--set limits.max_current=0.001 --set 'field.earth={field=[3e-4,0,0]}' ";
  const char* unreachable = "cannot produce a zero of the field at (360, 360) px";
  CHECK(notes(trap).find("zero of the field") == std::string::npos);
  const std::string stated = notes(trap + weak);
  CHECK(stated.find(unreachable) != std::string::npos);
  CHECK(stated.find(unreachable) ==
        stated.rfind(unreachable));  // the middle of the drop is also the setpoint
  // By the edge and a uniform field the same controller needs no zero.
  CHECK(notes("").find("zero of the field") == std::string::npos);
  // The zero of two coils drives cells away along one direction.
  CHECK(notes(trap + "--set field.file=" FABA_SCENES "/../rigs/thesis-two-coils.toml").find("a saddle") !=
        std::string::npos);
}
