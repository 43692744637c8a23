// Rendered videos of each imaging mode, from the scenario to the tracks: `run --as-seen`, then `track`
// without options.
#include <doctest/doctest.h>
#include <fmt/format.h>

#include <string>

#include "tests/e2e/program.h"

using namespace faba;

namespace {

constexpr int kCells = 60;
constexpr double kSpeed = 30;  // px/s

/// Tracks of cells that swim at one speed, in a video with these keys of the microscope.
nlohmann::json tracked(const std::string& microscope) {
  const TestFolder f;
  write_file(f.path / "s.toml",
             fmt::format("duration = '2 s'\n[camera]\nrate = '15 Hz'\n[arena]\ntype = 'box'\n"
                         "size_px = [640, 480]\n[scale]\num_per_px = 1\n[microscope]\n{}\n[[swarm]]\ncount = "
                         "{}\nmodel = {{ type = 'dipole', speed = '{} um/s', speed_sd = '0 um/s' }}\n"
                         "start = {{ type = 'uniform' }}\n[controller]\ntype = 'manual'\n"
                         "field = ['100 uT', '0 T']\n[record]\nas_seen = true\nlossless = true\n",
                         microscope, kCells, kSpeed));
  const Called run = faba_in(f.path, "run s.toml --seed 4 --out run -q");
  REQUIRE_MESSAGE(run.exit == 0, run.err);
  return json_in(f.path, "track run/video.avi");
}

void check_truth(const nlohmann::json& j, const char* polarity) {
  CHECK(j["detection"]["polarity"] == polarity);
  CHECK(j["detection"]["spots_per_frame"].get<double>() == doctest::Approx(kCells).epsilon(0.1));
  REQUIRE(j["speed"].is_object());
  CHECK(j["speed"]["mean_px_s"].get<double>() == doctest::Approx(kSpeed).epsilon(0.05));
}

}  // namespace

TEST_CASE("phase contrast: cells with halos are detected once, dark or bright") {
  check_truth(tracked("mode = 'phase_contrast'"), "dark");
  check_truth(tracked("mode = 'phase_contrast'\ncontrast = 0.6"), "bright");
}

TEST_CASE("fluorescence: bright cells are detected, also while they bleach") {
  check_truth(tracked("mode = 'fluorescence'"), "bright");
  check_truth(tracked("mode = 'fluorescence'\nbleaching_time = '1 s'"), "bright");
}

TEST_CASE("bright field: cells are dark") { check_truth(tracked("mode = 'bright_field'"), "dark"); }
