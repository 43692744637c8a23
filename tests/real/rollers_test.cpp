#include <doctest/doctest.h>

#include <filesystem>
#include <nlohmann/json.hpp>

#include "study/pages/tracks/track_json.h"
#include "study/pages/tracks/track_report.h"
#include "tests/skip.h"

using namespace faba;

namespace {
const std::filesystem::path kVideo =
    std::filesystem::path(FABA_SHARED_DATA) / "step-response" / "rollers.mp4";
}

TEST_CASE("rollers among dust in a coded video: no speed is trusted without the size of the rollers") {
  if (test::skipped_without(kVideo)) return;
  TrackOptions o;
  o.video = kVideo;
  o.part.to_s = 6;
  const auto j = track_json(track_video(o));
  CHECK(j["quality"] == "poor");
  bool named = false;
  for (const auto& w : j["warnings"]) named = named || w["aspect"] == "size";
  CHECK(named);
}

TEST_CASE(
    "rollers with the options of the guide: the driven speed, in the segment in which they are driven") {
  if (test::skipped_without(kVideo)) return;
  TrackOptions o;
  o.video = kVideo;
  o.part.from_s = 45.2;  // driven until 58.4 s
  o.part.to_s = 58.4;
  o.size_px = 24;
  o.threshold_sd = 60;
  o.tracker.min_points = 60;
  const auto j = track_json(track_video(o));
  CHECK(j["quality"] == "good");
  CHECK(j["tracks"].get<int>() >= 6);
  CHECK(j["tracks"].get<int>() <= 20);
  const auto fastest = j["populations"].back();
  CHECK(fastest["motion"] == "moving");
  // Measured by hand: about 49 px/s.
  CHECK(fastest["speed_px_per_s"].get<double>() == doctest::Approx(49).epsilon(0.1));
}
