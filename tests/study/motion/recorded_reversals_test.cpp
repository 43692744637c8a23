#include "study/motion/recorded_reversals.h"

#include <doctest/doctest.h>

#include <filesystem>

#include "core/file.h"

using namespace faba;

TEST_CASE("recorded reversals: the field turns, and south-seeking cells swim against it") {
  const auto run = std::filesystem::temp_directory_path() / "faba-recorded-reversals";
  std::filesystem::create_directories(run);
  write_file(run / "manifest.json", R"({"version": "1", "polarity": "south"})");
  // 1 mT to the right, then off, then to the left from directly after 0.3 s.
  write_file(run / "series.csv",
             "frame,t_s,field_x_ut,field_y_ut\n0,0.0,0,0\n1,0.1,1000,0\n2,0.2,0,0\n3,0.3,0,0\n4,0.4,-1000,0\n"
             "5,0.5,-1000,0\n6,0.6,-900,-500\n");
  const auto reversals = recorded_reversals(run);
  REQUIRE(reversals.size() == 1);
  CHECK(reversals[0].t_s == doctest::Approx(0.3));
  CHECK(reversals[0].direction_deg == doctest::Approx(0));
  CHECK(recorded_reversals(run / "series.csv").empty());
  std::filesystem::remove_all(run);
}
