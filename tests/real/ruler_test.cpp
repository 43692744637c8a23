#include <doctest/doctest.h>

#include <filesystem>

#include "app/scenario/calibration_file.h"
#include "study/pages/scale_report.h"
#include "tests/app/run_directory.h"
#include "tests/skip.h"

using namespace faba;

TEST_CASE("a stage micrometer through a 10x objective") {
  const std::filesystem::path picture = std::filesystem::path(FABA_SHARED_DATA) / "ruler" / "cal10.png";
  if (test::skipped_without(picture)) return;
  const TestFolder folder;
  const PictureScale s = report_scale_picture(picture, 10e-6, folder.path / "marks.png");
  // The picture has a label: 688.33 px for 89 ticks of 10 um, 1.293 um/px.
  CHECK(s.um_per_px == doctest::Approx(1.293).epsilon(0.01));
  CHECK(s.ratios.mean == doctest::Approx(1.293).epsilon(0.01));
  CHECK(s.ci95[0] < s.um_per_px);
  CHECK(s.ci95[1] > s.um_per_px);
  CHECK(s.marks > 80);
  CHECK(std::filesystem::exists(folder.path / "marks.png"));
}
