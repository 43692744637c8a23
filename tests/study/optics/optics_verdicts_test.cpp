// Verdicts of the planner: the thesis's setups, and the limits of each measurement.
#include "study/optics/optics_verdicts.h"

#include <doctest/doctest.h>

#include "study/motion/displacements.h"
#include "study/motion/response.h"
#include "study/tracks/track_warnings.h"

using namespace faba;

namespace {

OpticsVerdict verdict(const OpticsSetup& o, PlannedMeasurement m) {
  for (OpticsVerdict& v : optics_verdicts(o, optics_plan(o)))
    if (v.measurement == m) return v;
  return {};
}
Quality quality(const OpticsSetup& o, PlannedMeasurement m) { return verdict(o, m).quality(); }

OpticsSetup hundred() {
  OpticsSetup o;
  o.magnification = 100;
  o.numerical_aperture = 1.4;
  return o;
}

}  // namespace

TEST_CASE("each measurement has a verdict with its figures") {
  const OpticsSetup o;
  const auto all = optics_verdicts(o, optics_plan(o));
  REQUIRE(all.size() == kPlannedMeasurements.size());
  for (std::size_t i = 0; i < all.size(); ++i) {
    CHECK(all[i].measurement == kPlannedMeasurements[i]);
    CHECK_FALSE(all[i].evidence.empty());
  }
}

TEST_CASE("the thesis: a swarm is followed with 10x and leaves the view with 100x before it forms") {
  CHECK(quality({}, PlannedMeasurement::swarm) == Quality::good);
  CHECK(quality({}, PlannedMeasurement::response) == Quality::good);
  const OpticsVerdict v = verdict(hundred(), PlannedMeasurement::swarm);
  CHECK(v.quality() == Quality::poor);
  CHECK(v.warnings.at(0).what == "cells leave the view before a swarm forms");
  CHECK(quality(hundred(), PlannedMeasurement::response) == Quality::poor);
}

TEST_CASE("flow: the limits are those of FlowVerdict, and the advised frame rate is sufficient") {
  OpticsSetup o;
  CHECK(quality(o, PlannedMeasurement::flow) == Quality::poor);
  o.exposure_time = 0;  // the width does not depend on the speed
  o.frame_rate = 120;
  const OpticsPlan p = optics_plan(o);
  const double width = std::max(p.object_px, 2.0);
  for (const auto& [widths, expected] : {std::pair{0.99, Quality::good},
                                         {1.01, Quality::doubtful},
                                         {1.99, Quality::doubtful},
                                         {2.01, Quality::poor}}) {
    o.speed = widths * width * p.um_per_px * 1e-6 * o.frame_rate;
    CHECK(quality(o, PlannedMeasurement::flow) == expected);
    CHECK((expected != Quality::poor) == FlowVerdict{widths * width, width, {}}.valid());
  }
  CHECK(verdict(o, PlannedMeasurement::flow).warnings.at(0).advice == "use 242 frames per second or more");
  o.frame_rate = 242;
  CHECK(quality(o, PlannedMeasurement::flow) == Quality::good);
}

TEST_CASE("tracking: displacement against distance, with the limit of the warnings of faba track") {
  OpticsSetup o;
  o.frame_rate = 60;
  const OpticsPlan p = optics_plan(o);
  for (const auto& [step, expected] :
       {std::pair{0.2, Quality::good}, {0.27, Quality::doubtful}, {kFarStep + 0.01, Quality::poor}}) {
    o.cells_per_mm2 = 1e6 / std::pow(p.displacement_px * p.um_per_px / step, 2);
    CHECK(quality(o, PlannedMeasurement::tracking) == expected);
  }
}

TEST_CASE("tracking: cells that overlap, are smaller than a pixel, larger than the detector, or smeared") {
  OpticsSetup dense;
  dense.frame_rate = 1000;
  dense.cells_per_mm2 = 50000;
  CHECK(verdict(dense, PlannedMeasurement::tracking).warnings.at(0).aspect == "texture");
  OpticsSetup small;
  small.magnification = 4;
  small.numerical_aperture = 0.1;
  small.frame_rate = 60;
  CHECK(verdict(small, PlannedMeasurement::tracking).warnings.at(0).aspect == "size");
  OpticsSetup large = hundred();
  large.frame_rate = 1000;
  large.cell_diameter = 9e-6;
  CHECK(quality(large, PlannedMeasurement::tracking) == Quality::poor);
  OpticsSetup smeared;
  smeared.cells_per_mm2 = 50;
  smeared.exposure_time = 1 / smeared.frame_rate;
  CHECK(verdict(smeared, PlannedMeasurement::tracking).warnings.at(0).aspect == "blur");
}

TEST_CASE("response: time in view, frames, displacement and number of cells") {
  OpticsSetup o;
  o.um_per_px = 1e6 * 0.99 * (kResponseWait + kResponsePart) * o.speed / o.width_px;
  CHECK(quality(o, PlannedMeasurement::response) == Quality::poor);
  o.um_per_px = *o.um_per_px / 0.98;
  CHECK(quality(o, PlannedMeasurement::response) == Quality::poor);  // the displacement is too large
  o.frame_rate = 60;
  CHECK(quality(o, PlannedMeasurement::response) == Quality::good);
  o.cells_per_mm2 = 100;
  CHECK(quality(o, PlannedMeasurement::response) == Quality::doubtful);
  OpticsSetup slow;
  slow.speed = 20e-6;
  slow.frame_rate = 0.9 * double(kLeastShiftFrames) / kResponsePart;
  CHECK(verdict(slow, PlannedMeasurement::response).warnings.at(0).aspect == "frames");
}

TEST_CASE(
    "response: a swarm in view for a part of the measurement is doubtful, one that has left before it is "
    "poor") {
  OpticsSetup o;
  o.frame_rate = 240;
  o.cells_per_mm2 = 20000;
  const double start = kResponseWait + 6 / o.frame_rate, end = kResponseWait + kResponsePart;
  for (const auto& [crossing, expected] : {std::pair{0.99 * start, Quality::poor},
                                           {1.01 * start, Quality::doubtful},
                                           {0.99 * end, Quality::doubtful},
                                           {1.01 * end, Quality::good}}) {
    o.um_per_px = 1e6 * crossing * o.speed / o.width_px;
    CHECK(quality(o, PlannedMeasurement::response) == expected);
  }
}

TEST_CASE("edge: the arc and the error of its radius") {
  OpticsSetup o;
  o.drop_radius = 0.4e-3;
  CHECK(quality(o, PlannedMeasurement::edge) == Quality::good);
  o.drop_radius = 0.88e-3;
  CHECK(verdict(o, PlannedMeasurement::edge).warnings.at(0).aspect == "arc");
  CHECK(quality(hundred(), PlannedMeasurement::edge) != Quality::good);
  o.drop_radius = 40e-3;
  CHECK(quality(o, PlannedMeasurement::edge) == Quality::poor);
}
