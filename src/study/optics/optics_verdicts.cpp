#include "study/optics/optics_verdicts.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include <fmt/format.h>

#include "study/drop/drop_warnings.h"
#include "study/motion/displacement_sums.h"
#include "study/motion/displacements.h"
#include "study/motion/response.h"
#include "study/motion/response_frames.h"
#include "study/tracks/track_warnings.h"
#include "vision/cells/detector.h"
#include "vision/cells/tracker.h"

namespace faba {
namespace {

// Of the mean distance 1 / sqrt(density): half the mean distance to the nearest neighbour, the limit of
// tracking without a common direction (theory H2).
constexpr double kHardStep = 0.25;
constexpr double kFullTrack =
    10;  // frames: tracks of ten frames without gaps have a score of 0.8 (theory H7)
constexpr double kLongStreak = 3;  // widths: a longer object may be detected twice (theory H1)
// Fewer cells do not determine the distribution of the displacements within a second
// (bench/results/optics.md).
constexpr double kFewInView = 30;
// Displacement of the fastest cells over the mean: two standard deviations, 45 / 186 for IT-1 (thesis).
constexpr double kFastest = 1 + 2 * 45.0 / 186;
// Fraction of the mean way to the edge of the drop that a cell is in view. Assumed.
constexpr double kMostOfTheWay = 0.5, kPartOfTheWay = 0.25;

// Three significant digits, rounded up, for a limit that must be reached.
std::string at_least(double value) {
  const double digit = std::pow(10.0, std::floor(std::log10(value)) - 2);
  return fmt::format("{:g}", std::ceil(value / digit - 1e-9) * digit);
}
std::string at_most(double value) {
  const double digit = std::pow(10.0, std::floor(std::log10(value)) - 2);
  return fmt::format("{:g}", std::floor(value / digit + 1e-9) * digit);
}

// The width of the picture of a cell for which the measurements detect it.
double detected_width(const OpticsPlan& p) { return std::max(p.object_px, kSmallestSpot); }

// Frame rate at which cells move by their width between frames. A shorter exposure makes them narrower.
double flow_rate(OpticsSetup o) {
  constexpr int kRepeats = 20;
  for (int i = 0; i < kRepeats; ++i) {
    const OpticsPlan p = optics_plan(o);
    o.frame_rate *= p.displacement_px / detected_width(p);
    if (o.exposure_time) o.exposure_time = std::min(*o.exposure_time, 1 / o.frame_rate);
  }
  return o.frame_rate;
}

OpticsVerdict flow_verdict(const OpticsSetup& o, const OpticsPlan& p) {
  const FlowVerdict v{p.displacement_px, detected_width(p), {}};
  OpticsVerdict out{.measurement = PlannedMeasurement::flow};
  out.evidence = fmt::format("{:.3g} px between frames, width {:.2g} px", v.shift_px, v.object_px);
  if (v.follows()) return out;
  const std::string advice = fmt::format("use {} frames per second or more", at_least(flow_rate(o)));
  if (v.valid())
    out.warnings.push_back({"frame_rate",
                            "cells move by more than their width between frames: the optical flow is smaller "
                            "than their displacement, and its direction may be wrong",
                            out.evidence, advice});
  else
    out.warnings.push_back(
        {"frame_rate",
         "cells move by more than twice their width between frames: the optical flow has no "
         "direction and is an index of activity only",
         out.evidence, advice, Quality::poor});
  return out;
}

void warn_crowding(OpticsVerdict& v, const OpticsSetup& o, const OpticsPlan& p) {
  const double step = p.displacement_px / p.spacing_px;
  if (step <= kHardStep) return;
  const double factor = step / kHardStep;
  v.warnings.push_back(
      {"crowding",
       "the displacement of cells between frames is similar to their distance: tracks join different cells, "
       "and "
       "speeds are too small",
       v.evidence,
       fmt::format("use {} frames per second or more, or at most {} cells per mm2",
                   at_least(o.frame_rate * factor), at_most(o.cells_per_mm2 / (factor * factor))),
       step > kFarStep ? Quality::poor : Quality::doubtful});
}

void warn_overlap(OpticsVerdict& v, const OpticsSetup& o, const OpticsPlan& p) {
  const double covered = std::numbers::pi / 4 * std::pow(p.object_px / p.spacing_px, 2);
  if (covered <= kCoveredPicture) return;
  v.warnings.push_back({"texture", "cells are so dense that their pictures overlap",
                        fmt::format("cells cover {:.0f} % of the picture", 100 * std::min(1.0, covered)),
                        fmt::format("dilute the sample to {} cells per mm2",
                                    at_most(o.cells_per_mm2 * kCoveredPicture / covered)),
                        covered > 3 * kCoveredPicture ? Quality::poor : Quality::doubtful});
}

void warn_short_tracks(OpticsVerdict& v, const OpticsSetup& o, const OpticsPlan& p) {
  const int least = TrackerOptions{}.min_points;
  if (p.crossing_frames >= kFullTrack) return;
  v.warnings.push_back(
      {"frames", "cells leave the view after a few frames: tracks are short",
       fmt::format("a cell crosses the view in {:.2g} frames; a track needs {}", p.crossing_frames, least),
       fmt::format("use {} frames per second or more, or a lower magnification",
                   at_least(o.frame_rate * kFullTrack / p.crossing_frames)),
       p.crossing_frames < least ? Quality::poor : Quality::doubtful});
}

void warn_spot(OpticsVerdict& v, const OpticsPlan& p) {
  if (p.cell_px < 1)
    v.warnings.push_back({"size",
                          "cells are smaller than a pixel: they have little contrast and may not be detected",
                          fmt::format("{:.2g} px", p.cell_px), "use a higher magnification"});
  if (p.object_px > kLargestSpot)
    v.warnings.push_back({"size", "cells are larger than the sizes that are detected without options",
                          fmt::format("{:.3g} px; at most {:g} px", p.object_px, kLargestSpot),
                          "give --size, or use a lower magnification",
                          p.object_px > kLargestDetected ? Quality::poor : Quality::doubtful});
  if (p.cell_length_px + p.blur_px > kLongStreak * p.object_across_px)
    v.warnings.push_back(
        {"blur", "cells appear as long streaks, which may be detected twice",
         fmt::format("{:.3g} px long, {:.2g} px wide; {:.2g} px are motion during the exposure",
                     p.cell_length_px + p.blur_px, p.object_across_px, p.blur_px),
         "use a shorter exposure"});
}

OpticsVerdict tracking_verdict(const OpticsSetup& o, const OpticsPlan& p) {
  OpticsVerdict v{.measurement = PlannedMeasurement::tracking};
  v.evidence =
      fmt::format("{:.3g} px between frames, mean distance {:.3g} px", p.displacement_px, p.spacing_px);
  warn_crowding(v, o, p);
  warn_overlap(v, o, p);
  warn_short_tracks(v, o, p);
  warn_spot(v, p);
  return v;
}

// The image correlation needs the displacements of all cells in its range.
void warn_long_shift(OpticsVerdict& v, const OpticsSetup& o, const OpticsPlan& p) {
  const int side = (std::max(o.width_px, o.height_px) + kLongResponseSide - 1) / kLongResponseSide;
  const double longest = (kLongestShift * side - p.object_px) / kFastest;
  if (p.displacement_px <= longest) return;
  // A wide object leaves no displacement that can be found.
  const bool too_wide = longest < p.object_px;
  v.warnings.push_back(
      {"displacement",
       "the displacement of cells between frames is larger than the image correlation can find",
       fmt::format("{:.3g} px between frames; at most {:.3g} px", p.displacement_px, std::max(0.0, longest)),
       too_wide ? "use a lower magnification"
                : fmt::format("use {} frames per second or more",
                              at_least(o.frame_rate * p.displacement_px / longest)),
       Quality::poor});
}

OpticsVerdict response_verdict(const OpticsSetup& o, const OpticsPlan& p) {
  const double needed = kResponseWait + kResponsePart;
  OpticsVerdict v{.measurement = PlannedMeasurement::response};
  v.evidence =
      fmt::format("a swarm crosses the view in {:.3g} s; {:.2g} s are measured", p.crossing_time, needed);
  // A swarm that is in view for the smallest number of frames is measured, but its fast cells have left.
  const double least = kResponseWait + double(kLeastShiftFrames) / o.frame_rate;
  const bool gone = p.crossing_time < std::min(least, needed);
  if (p.crossing_time < needed)
    v.warnings.push_back({"view",
                          gone ? "cells that leave the edge of a drop have crossed the view before their "
                                 "speed and the responding "
                                 "fraction are measured"
                               : "fast cells that leave the edge of a drop have crossed the view before the "
                                 "end of the measurement",
                          v.evidence,
                          fmt::format("use a magnification of {} or less, or more pixels",
                                      at_most(o.magnification * p.crossing_time / needed)),
                          gone ? Quality::poor : Quality::doubtful});
  if (kResponsePart * o.frame_rate < double(kLeastShiftFrames))
    v.warnings.push_back(
        {"frames", "the measured part of the response has too few frames",
         fmt::format("{:.2g} frames in {:g} s", kResponsePart * o.frame_rate, kResponsePart),
         fmt::format("use {} frames per second or more", double(kLeastShiftFrames) / kResponsePart),
         Quality::poor});
  warn_long_shift(v, o, p);
  if (p.cells_in_view < kFewInView)
    v.warnings.push_back({"sample",
                          "there are few cells in view: the distribution of their displacements is uncertain",
                          fmt::format("{:.2g} cells; {:g} are needed", p.cells_in_view, kFewInView),
                          "use a lower magnification or more cells, or track single cells"});
  return v;
}

OpticsVerdict edge_verdict(const OpticsPlan& p) {
  OpticsVerdict v{.measurement = PlannedMeasurement::edge};
  v.evidence =
      fmt::format("{:.0f} degrees of the edge are in view; the standard error of the radius is {:.2g} %",
                  p.arc_deg, 100 * p.radius_error);
  const char* advice = "use a lower magnification or a smaller drop";
  if (p.radius_error > kUncertainRadius)
    v.warnings.push_back({"radius", "the visible arc does not determine the radius well", v.evidence, advice,
                          p.radius_error > kUselessRadius ? Quality::poor : Quality::doubtful});
  else if (p.arc_deg < kShortArc)
    v.warnings.push_back(
        {"arc",
         "only a short arc of the edge is visible: an edge that is not exactly circular gives "
         "another radius",
         fmt::format("{:.0f} degrees", p.arc_deg), advice});
  return v;
}

OpticsVerdict swarm_verdict(const OpticsSetup& o, const OpticsPlan& p) {
  OpticsVerdict v{.measurement = PlannedMeasurement::swarm};
  v.evidence = fmt::format(
      "a cell crosses the view in {:.2g} s; a swarm needs {:.2g} s to gather at the edge of "
      "the drop",
      p.crossing_time, p.gathering_time);
  const double seen = p.crossing_time / p.gathering_time;
  if (seen >= kMostOfTheWay) return v;
  const bool poor = seen < kPartOfTheWay;
  v.warnings.push_back({"view",
                        poor ? "cells leave the view before a swarm forms"
                             : "only a part of the way of the cells to the swarm is in view",
                        v.evidence,
                        fmt::format("use a magnification of {} or less, or more pixels",
                                    at_most(o.magnification * seen / kMostOfTheWay)),
                        poor ? Quality::poor : Quality::doubtful});
  return v;
}

}  // namespace

const char* word_of(PlannedMeasurement measurement) {
  switch (measurement) {
    case PlannedMeasurement::flow:
      return "flow";
    case PlannedMeasurement::tracking:
      return "tracking";
    case PlannedMeasurement::response:
      return "response";
    case PlannedMeasurement::edge:
      return "drop_edge";
    case PlannedMeasurement::swarm:
      return "swarm";
  }
  return "";
}

const char* title_of(PlannedMeasurement measurement) {
  switch (measurement) {
    case PlannedMeasurement::flow:
      return "Optical flow";
    case PlannedMeasurement::tracking:
      return "Tracks of single cells";
    case PlannedMeasurement::response:
      return "Response to a field reversal";
    case PlannedMeasurement::edge:
      return "Edge of the drop";
    case PlannedMeasurement::swarm:
      return "Formation of a swarm";
  }
  return "";
}

std::vector<OpticsVerdict> optics_verdicts(const OpticsSetup& o, const OpticsPlan& p) {
  return {flow_verdict(o, p), tracking_verdict(o, p), response_verdict(o, p), edge_verdict(p),
          swarm_verdict(o, p)};
}

}  // namespace faba
