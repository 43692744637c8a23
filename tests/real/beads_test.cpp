#include <doctest/doctest.h>

#include <filesystem>
#include <nlohmann/json.hpp>

#include "study/pages/tracks/track_json.h"
#include "study/pages/tracks/track_report.h"
#include "tests/skip.h"

using namespace faba;

namespace {
const std::filesystem::path kVideo = std::filesystem::path(FABA_SHARED_DATA) / "beads" / "bulk-water.mov";
}

TEST_CASE("beads of 1 um in water diffuse with the Stokes-Einstein coefficient, and do not swim") {
  if (test::skipped_without(kVideo)) return;
  TrackOptions o;
  o.video = kVideo;
  o.scale.um_per_px = 100.0 / 285;  // value of the trackpy walkthrough for these beads
  const auto j = track_json(track_video(o));
  CHECK(j["frames"] == 480);
  CHECK(j["supported"] == "diffusion");
  // kT / (6 pi eta a), a = 0.5 um: 0.40 um^2/s at 17 C, 0.49 at 25 C. The scale has an error of some per
  // cent, which doubles in D.
  const double d = j["diffusion"]["d_um2_s"];
  CHECK(d > 0.38);
  CHECK(d < 0.52);
  CHECK(j["alpha"].get<double>() == doctest::Approx(1).epsilon(0.06));
  CHECK(j["quality"] == "good");
}
