#include <doctest/doctest.h>
#include <fmt/format.h>

#include <cmath>
#include <filesystem>
#include <string>
#include <vector>

#include "core/error.h"
#include "tests/skip.h"
#include "vision/drop/drop_edge.h"
#include "vision/files/picture.h"

using namespace faba;

namespace {

const std::filesystem::path kShared = FABA_SHARED_DATA;

std::string why_refused(const std::filesystem::path& file) {
  DropEdgeOptions options;
  options.name = file.filename().string();
  try {
    const DropEdge d = find_drop_edge(read_picture(file).grey, options);
    return fmt::format("found radius {} at ({}, {})", d.radius_px, d.centre_image.x, d.centre_image.y);
  } catch (const Error& e) {
    CHECK(e.code() == Errc::input);
    return e.what();
  }
}

}  // namespace

TEST_CASE("ten frames of one drop of E. coli") {
  if (test::skipped_without(kShared / "drops")) return;
  std::vector<double> radii;
  for (int k = 0; k < 10; ++k) {
    const auto file = kShared / "drops" / fmt::format("{:05d}.tif", k);
    CAPTURE(file.string());
    const DropEdge d = find_drop_edge(read_picture(file).grey);
    // A mask drawn by hand gives the centre (258.5, 228.5). Radius of the steepest edge 160 to 161, of the
    // half level 163, of the mask 166 px.
    CHECK(norm(d.centre_image - Vec2{258.5, 228.5}) < 2);
    CHECK(d.radius_px > 158);
    CHECK(d.radius_px < 167);
    CHECK(d.arc_deg > 340);
    CHECK(d.centre_side_inside);
    CHECK(norm(d.inside_image - d.centre_image) < d.radius_px);
    CHECK(d.contrast > 0);  // bright inside
    radii.push_back(d.radius_px);
  }
  // The drop does not change in ten frames, so the scatter of the radii is the error.
  double mean = 0, square = 0;
  for (double r : radii) mean += r / double(radii.size());
  for (double r : radii) square += (r - mean) * (r - mean) / double(radii.size() - 1);
  CHECK(std::sqrt(square) < 1.5);
}

TEST_CASE("pictures without a drop are refused") {
  if (test::skipped_without(kShared / "suspension")) return;
  for (const auto& entry : std::filesystem::directory_iterator(kShared / "suspension"))
    if (entry.path().extension() == ".tif")
      CHECK(why_refused(entry.path()).find("no drop edge") != std::string::npos);
  CHECK(why_refused(kShared / "ruler" / "cal10.png").find("straight") != std::string::npos);
  CHECK(why_refused(kShared / "beads" / "bulk-water.mov").find("no drop edge") != std::string::npos);
  CHECK(why_refused(kShared / "step-response" / "rollers.mp4").find("no drop edge") != std::string::npos);
}
