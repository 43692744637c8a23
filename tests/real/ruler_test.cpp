#include <doctest/doctest.h>

#include <filesystem>

#include "app/scenario/calibration_file.h"
#include "study/pages/scale.h"
#include "tests/app/run_directory.h"

using namespace faba;

TEST_CASE("a stage micrometer through a 10x objective") {
  const std::filesystem::path picture = std::filesystem::path(FABA_SHARED_DATA) / "ruler" / "cal10.png";
  if (!std::filesystem::exists(picture)) {
    MESSAGE("skipped: no real data");
    return;
  }
  const TestFolder folder;
  const auto j = report_scale_picture(picture, 10e-6, folder.path / "marks.png");
  // Burnt into the picture: 688.33 px for 89 ticks of 10 um, 1.293 um/px.
  CHECK(j["um_per_px"].get<double>() == doctest::Approx(1.293).epsilon(0.01));
  CHECK(j["ratio_mean"].get<double>() == doctest::Approx(1.293).epsilon(0.01));
  CHECK(j["ci95"][0].get<double>() < j["um_per_px"].get<double>());
  CHECK(j["ci95"][1].get<double>() > j["um_per_px"].get<double>());
  CHECK(j["marks"].get<int>() > 80);
  CHECK(std::filesystem::exists(folder.path / "marks.png"));
}
