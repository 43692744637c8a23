// Laws of the plan: how its figures depend on magnification, frame rate, speed and drop.
#include "study/optics/optics_plan.h"

#include <doctest/doctest.h>

#include <cmath>
#include <numbers>

#include "core/error.h"
#include "core/toml.h"

using namespace faba;

namespace {

constexpr double kUm = 1e-6;

OpticsSetup setup_of(const char* toml) {
  const Document d = parse_toml(toml, "s.toml");
  return OpticsSetup::schema().parse(Node(d));
}

}  // namespace

TEST_CASE("the defaults are the thesis's setup at 10x") {
  const OpticsPlan p = optics_plan({});
  CHECK(p.um_per_px == doctest::Approx(0.8015));  // table 4.1
  CHECK(p.view_width == doctest::Approx(640 * 0.8015 * kUm));
  CHECK(p.view_height == doctest::Approx(480 * 0.8015 * kUm));
  CHECK(p.cell_px == doctest::Approx(1.4 / 0.8015));
  CHECK(p.displacement_px == doctest::Approx(186 / 15.0 / 0.8015));
  CHECK(p.crossing_time == doctest::Approx(640 * 0.8015 / 186));
}

TEST_CASE("a ten times larger magnification gives a tenth of the view and of the crossing time") {
  const OpticsPlan a = optics_plan(setup_of("preset = '10x'")), b = optics_plan(setup_of("preset = '100x'"));
  CHECK(b.um_per_px == doctest::Approx(a.um_per_px / 10));
  CHECK(b.view_width == doctest::Approx(a.view_width / 10));
  CHECK(b.crossing_time == doctest::Approx(a.crossing_time / 10));
  CHECK(b.cells_in_view == doctest::Approx(a.cells_in_view / 100));
  CHECK(b.displacement_px == doctest::Approx(10 * a.displacement_px));
  CHECK(b.spacing_px == doctest::Approx(10 * a.spacing_px));
  CHECK(b.gathering_time == doctest::Approx(a.gathering_time));  // of the drop and the cells only
}

TEST_CASE("the resolution is proportional to 1 / NA, the depth of field to its square") {
  OpticsSetup o;
  const OpticsPlan a = optics_plan(o);
  o.numerical_aperture *= 2;
  const OpticsPlan b = optics_plan(o);
  CHECK(b.resolution == doctest::Approx(a.resolution / 2));
  CHECK(b.depth_of_field == doctest::Approx(a.depth_of_field / 4));
  CHECK(a.psf_sd == doctest::Approx(0.46e-6).epsilon(0.01));         // as in the rendered microscope
  CHECK(a.depth_of_field == doctest::Approx(6.4e-6).epsilon(0.02));  // the same
}

TEST_CASE("blur and displacement are speed times time") {
  OpticsSetup o;
  o.exposure_time = 0.02;
  const OpticsPlan a = optics_plan(o);
  CHECK(a.blur_px == doctest::Approx(a.displacement_px * 0.02 * o.frame_rate));
  o.speed *= 3;
  const OpticsPlan b = optics_plan(o);
  CHECK(b.blur_px == doctest::Approx(3 * a.blur_px));
  CHECK(b.crossing_time == doctest::Approx(a.crossing_time / 3));
  CHECK(b.object_px > a.object_px);
}

TEST_CASE("the scale: given, or from the size of a pixel") {
  CHECK(optics_plan(setup_of("um_per_px = 0.5\nmagnification = 20")).um_per_px == 0.5);
  CHECK(optics_plan(setup_of("pixel_size = '7.4 um'\ntube_factor = 0.75")).um_per_px ==
        doctest::Approx(7.4 / 7.5));
  CHECK_THROWS_WITH_AS(setup_of("um_per_px = 0.5\npixel_size = '7.4 um'"), doctest::Contains("two ways"),
                       Error);
  CHECK_THROWS_AS(setup_of("frame_rate = '100 Hz'\nexposure_time = '11 ms'"), Error);
  CHECK_THROWS_AS(setup_of("cell_length = '1 um'"), Error);
}

TEST_CASE("the gathering time is the mean distance of a disc's points from its edge over the speed") {
  OpticsSetup o;
  double sum = 0;
  int n = 0;
  constexpr int kSteps = 1000;  // points on a grid of the unit disc
  for (int i = 0; i < kSteps; ++i)
    for (int j = 0; j < kSteps; ++j) {
      const double x = (2 * i + 1.0) / kSteps - 1, y = (2 * j + 1.0) / kSteps - 1;
      if (x * x + y * y >= 1) continue;
      sum += std::sqrt(1 - y * y) - x;
      ++n;
    }
  CHECK(optics_plan(o).gathering_time == doctest::Approx(sum / n * o.drop_radius / o.speed).epsilon(0.002));
}

TEST_CASE("the arc of the edge in view, and the error of its radius") {
  OpticsSetup o;
  o.um_per_px = 0.8;
  o.height_px = 480;
  o.drop_radius = 240 * 0.8 * kUm / std::sin(15 * std::numbers::pi / 180);
  const OpticsPlan a = optics_plan(o);
  CHECK(a.arc_deg == doctest::Approx(30));
  o.drop_radius *= 4;  // sd(R) / R = sqrt(45 / n) / (R half_arc^2) px: proportional to R
  CHECK(optics_plan(o).radius_error == doctest::Approx(4 * a.radius_error).epsilon(0.05));
  o.drop_radius = 100 * kUm;  // all of it in view
  CHECK(optics_plan(o).arc_deg == 360);
  CHECK(optics_plan(o).radius_error < 0.001);
}
