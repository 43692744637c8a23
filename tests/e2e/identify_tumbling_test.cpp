// `faba identify` of cells that tumble, which no candidate describes.
#include <doctest/doctest.h>
#include <fmt/format.h>

#include <string>

#include "tests/e2e/program.h"

using namespace faba;

// Without tumbling, "basic" resembles these cells more than "dipole" does, and fits.
TEST_CASE(
    "cells that tumble: the evidence for a model that does not tumble is not clear, and turning is named") {
  const TestFolder f;
  std::string scene =
      "duration = '13 s'\n[scale]\num_per_px = 1.16\n[microscope]\ncell_diameter = '2.5 um'\n"
      "noise = 0.0069\ncontrast = -0.41\n"
      "[arena]\ntype = 'drop'\nview_px = [320, 240]\nradius_px = 562\ncentre_px = [-269, 120]\n"
      "[[swarm]]\ncount = 496\nstart = { type = 'edge', direction = '0 deg', visible = true }\n"
      "model = { type = 'dipole', speed = '120 um/s', speed_sd = '24 um/s', tumble_rate = '2 1/s' }\n"
      "[controller]\ntype = 'manual'\nfield = ['-115 uT', '6 uT']\n";
  for (int k = 0; k < 6; ++k)
    scene += fmt::format("[[controller.segment]]\nat = '{} s'\nfield = ['{} uT', '{} uT']\n", 1 + 2 * k,
                         k % 2 == 0 ? 115 : -115, k % 2 == 0 ? -6 : 6);
  write_file(f.path / "scene.toml", scene + "[record]\nas_seen = true\nlossless = true\ntracks = false\n");
  REQUIRE(faba_in(f.path, "run scene.toml --seed 7001 --quiet --out film").exit == 0);
  write_file(f.path / "study.toml",
             "simulations = 150\nboundary = 'drop'\n[[video]]\nfile = 'film'\n"
             "[[model]]\ntype = 'basic'\nfree = { 'swarm[0].model.max_speed' = [1, 20] }\n"
             "[[model]]\ntype = 'dipole'\nfree = { 'swarm[0].model.speed' = ['20 um/s', '300 um/s'] }\n");
  const auto j = json_in(f.path, "identify study.toml --out out");
  CHECK(j["evidence"] != "clear");
  bool turning = false;
  for (const auto& w : j.value("warnings", nlohmann::json::array()))
    turning = turning || w["aspect"] == "turning";
  CHECK(turning);
}
