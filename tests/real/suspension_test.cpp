#include <doctest/doctest.h>

#include <filesystem>
#include <nlohmann/json.hpp>

#include "study/pages/tracks/track_json.h"
#include "study/pages/tracks/track_report.h"
#include "tests/skip.h"

using namespace faba;

namespace {
const std::filesystem::path kFolder = std::filesystem::path(FABA_SHARED_DATA) / "suspension";
}

TEST_CASE("rods in a suspension swim on straight paths in random directions") {
  if (test::skipped_without(kFolder)) return;
  TrackOptions o;
  o.video = kFolder / "frame_*.tif";
  o.part.fps = 26.87;
  o.scale.um_per_px = 1 / 2.2;
  const auto j = track_json(track_video(o));
  CHECK(j["frames"] == 25);
  CHECK(j["supported"] == "persistent_walk");
  // Typical swimming speeds of rods of this size: 10 to 40 um/s. Most objects that do not move are dirt and
  // spheres.
  const auto q = j["speed"]["quantiles_10_50_90_um_s"];
  CHECK(q[2].get<double>() > 25);
  CHECK(q[2].get<double>() < 45);
  CHECK(j["alpha"].get<double>() > 1.8);
  CHECK(j["order"].get<double>() < 0.25);  // no common direction
  // About half of the objects do not move, and a mean over all of them describes neither half.
  CHECK(j["quality"] == "good");
  REQUIRE(j["populations"].size() == 2);
  CHECK(j["populations"][0]["motion"] == "still");
  CHECK(j["populations"][1]["motion"] == "moving");
  CHECK(j["populations"][1]["fraction"].get<double>() == doctest::Approx(0.5).epsilon(0.2));
  CHECK(j["populations"][1]["speed_um_per_s"].get<double>() > 20);
  CHECK(j["populations"][1]["speed_um_per_s"].get<double>() < 40);
}
