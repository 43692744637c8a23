#include "study/tracks/track_warnings.h"

#include <cmath>
#include <numbers>

#include <fmt/format.h>

#include "study/tracks/track_result.h"

namespace faba {
namespace {

// Noise of a pixel at which the detector stops (see Background): less is below the quantisation to integers.
constexpr double kNoNoise = 0.25;
constexpr double kFaint = 4;  // times the threshold: a median below it is a tail of noise or texture
constexpr double kCovered =
    0.05;  // of the picture: spots this dense overlap the rings of their local offsets
constexpr double kDoubtfulLinks = 0.9, kPoorLinks = 0.75;  // fraction of the links that are reproduced
constexpr double kFarStep = 0.3;   // of the mean distance between objects: tracks then often join wrong ones
constexpr double kFastTurn = 1.5;  // frames: a shorter persistence time is typical of steps to wrong objects
constexpr double kShort = 0.5;     // fraction of detections outside of tracks

double area_of(const TrackMeasurement& m) { return double(m.width) * m.height; }

// Fraction of the picture that is covered by the detected spots.
double covered(const TrackMeasurement& m) {
  const double size = m.detection.size_px;
  return m.detection.spots_per_frame * std::numbers::pi / 4 * size * size / area_of(m);
}

void warn_coding(const TrackMeasurement& m, std::vector<Warning>& out) {
  const TrackDetection& d = m.detection;
  if (d.threshold_given || !d.median_snr || d.noise_grey > kNoNoise ||
      *d.median_snr > kFaint * d.threshold_snr)
    return;
  out.push_back(
      {"noise",
       "the video has no noise that the detections could be compared with: it was coded, or its grey levels "
       "are too coarse, and many detections are artefacts",
       fmt::format("noise {:.2g} grey levels; the median signal-to-noise ratio of the detections is {:.3g}, "
                   "the threshold {:.3g}",
                   d.noise_grey, *d.median_snr, d.threshold_snr),
       "use a video that was not compressed, or give --size and --threshold for the objects that you see",
       Quality::poor});
}

void warn_texture(const TrackMeasurement& m, std::vector<Warning>& out) {
  const double share = covered(m);
  if (share < kCovered) return;
  out.push_back({"texture",
                 "the picture is full of detections: they are parts of a texture, or objects so dense that "
                 "their pictures overlap",
                 fmt::format("{:.3g} detections per frame cover {:.0f} % of the picture",
                             m.detection.spots_per_frame, 100 * share),
                 "look at --picture; give the --size of the objects, or dilute the sample",
                 share > 3 * kCovered ? Quality::poor : Quality::doubtful});
}

void warn_links(const TrackMeasurement& m, std::vector<Warning>& out) {
  const std::optional<double>& links = m.joining.reproduced;
  if (!links || *links >= kDoubtfulLinks) return;
  out.push_back(
      {"linking",
       "the tracks depend on single frames: without every fourth frame, other detections are linked",
       fmt::format("{:.0f} % of the links across an omitted frame are reproduced", 100 * *links),
       "use a higher frame rate or fewer objects, or a smaller --reach",
       *links < kPoorLinks ? Quality::poor : Quality::doubtful});
}

void warn_motion(const TrackMeasurement& m, std::vector<Warning>& out) {
  const TrackSummary& s = m.summary;
  const double spacing = std::sqrt(area_of(m) / std::max(1.0, m.detection.spots_per_frame));
  const double step = s.speed_count > 0 ? s.mean_speed_px_s.value * m.frame_s : 0;
  if (m.joining.crowded || step > kFarStep * spacing) {
    out.push_back(
        {"crowding",
         "the displacement of objects between frames is similar to their distance: many tracks join "
         "different objects, and speeds are too small",
         fmt::format("mean displacement {:.3g} px per frame, mean distance {:.3g} px", step, spacing),
         "use a higher frame rate or fewer objects", Quality::poor});
    return;
  }
  if (supported_walk(s) == SupportedWalk::persistent && !s.persistent.tau_open &&
      (!s.persistent.good || s.tau_s.value < kFastTurn * m.frame_s))
    out.push_back(
        {"frame_rate",
         "objects turn faster than the frame rate resolves, or tracks join different objects; speeds are too "
         "small",
         s.persistent.good ? fmt::format("the persistence time is {:.3g} frames; at least {:g} are needed",
                                         s.tau_s.value / m.frame_s, kFastTurn)
                           : "the persistence time could not be determined",
         "use a higher frame rate, or a smaller --reach"});
}

void warn_lengths(const TrackMeasurement& m, std::vector<Warning>& out) {
  const double all = m.detection.spots_per_frame * double(m.frames);
  if (m.frames < 2 * std::int64_t{m.joining.min_points} || all < 100) return;
  const double outside = 1 - double(m.summary.points) / all;
  if (outside < kShort) return;
  out.push_back(
      {"detection",
       "most detections do not belong to a track: they are noise, or objects are seen in single frames only",
       fmt::format("{:.0f} % of the detections", 100 * outside),
       "increase --threshold, or give the --size of the objects"});
}

}  // namespace

std::vector<Warning> track_warnings(const TrackMeasurement& m) {
  std::vector<Warning> out;
  if (m.frames < 2 || m.summary.tracks == 0) return out;
  warn_coding(m, out);
  warn_texture(m, out);
  warn_links(m, out);
  warn_motion(m, out);
  warn_lengths(m, out);
  return out;
}

}  // namespace faba
