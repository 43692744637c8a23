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
// The same for the errors of a codec, whose sd is measured (assumed; beads in a coded video have 1.3).
constexpr double kWeak = 1.25;
constexpr double kDoubtfulLinks = 0.9, kPoorLinks = 0.75;  // fraction of the links that are reproduced
constexpr double kFastTurn = 1.5;  // frames: a shorter persistence time is typical of steps to wrong objects
constexpr double kShort = 0.5;     // fraction of detections outside of tracks

constexpr double kBiasedSpeed = 0.5;  // drift over speed: the mean speed is then 6 % too large
constexpr double kIsotropic = 0.5;    // ratio of the variances of the velocity along its main axes
// Score below which tracks have gaps in a third of the frames, or hardly any link that could be tested.
constexpr double kLowScore = 0.6;
constexpr double kSignificantDrift = 3;  // standard errors

// Fraction of the searched area that is covered by the detected spots.
double covered(const TrackDetection& d) {
  return d.spots_per_frame * std::numbers::pi / 4 * d.size_px * d.size_px / d.searched_px2;
}

// The errors of coding have a wider distribution than noise: a detection near the threshold may be one.
void warn_coding(const TrackDetection& d, std::vector<Warning>& out) {
  if (d.threshold_given || !d.median_snr || !d.coding.coded() || *d.median_snr > kWeak * d.threshold_snr)
    return;
  out.push_back(
      {"coding",
       "the video was coded with losses, and its objects are hardly stronger than the errors of the "
       "codec: objects are missed or displaced, and some detections are artefacts",
       fmt::format("the changes are {:.0f} % larger across the edges of blocks of 8 px; the median "
                   "signal-to-noise ratio of the detections is {:.3g}, the threshold {:.3g}",
                   100 * d.coding.block_steps, *d.median_snr, d.threshold_snr),
       "use a video that was not compressed, or compressed without losses"});
}

void warn_noise(const TrackDetection& d, std::vector<Warning>& out) {
  if (d.coding.coded()) return;
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

void warn_texture(const TrackDetection& d, std::vector<Warning>& out) {
  const double share = covered(d);
  if (share < kCoveredPicture) return;
  out.push_back({"texture",
                 "the picture is full of detections: they are parts of a texture, or objects so dense that "
                 "their pictures overlap",
                 fmt::format("{:.3g} detections per frame cover {:.0f} % of the picture", d.spots_per_frame,
                             100 * share),
                 "look at --preview; give the --size of the objects, or dilute the sample",
                 share > 3 * kCoveredPicture ? Quality::poor : Quality::doubtful});
}

void warn_size(const TrackDetection& d, std::vector<Warning>& out) {
  if (!d.two_sizes) return;
  const bool mixed = d.two_sizes->most_have_other;  // the detections are of objects of both sizes
  out.push_back(
      {"size",
       mixed ? "the size of the objects is ambiguous: the strongest objects are not of the most frequent size"
             : "the size of the objects is ambiguous: two sizes are frequent",
       fmt::format("{:.2g} and {:.2g} px; {:.2g} px is used", d.two_sizes->smaller_px, d.two_sizes->larger_px,
                   d.size_px),
       "look at --preview and give the --size of the objects that you want to track",
       mixed ? Quality::poor : Quality::doubtful});
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

void warn_scores(const TrackMeasurement& m, std::vector<Warning>& out) {
  const ScoreSummary s = summary_of(m.scores);
  if (!s.mean || *s.mean >= kLowScore) return;
  out.push_back(
      {"linking", "the tracks are short or have gaps, and it is not known whether their links are right",
       fmt::format("their mean score is {:.2f}; tracks of ten frames without gaps have 0.8", *s.mean),
       "use more frames, or give --size and a larger --least"});
}

void warn_motion(const TrackMeasurement& m, std::vector<Warning>& out) {
  const TrackSummary& s = m.summary;
  const double spacing = std::sqrt(m.detection.searched_px2 / std::max(1.0, m.detection.spots_per_frame));
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

void warn_stage(const TrackMeasurement& m, std::vector<Warning>& out) {
  const StageDrift& d = m.stage;
  const std::string evidence =
      fmt::format("{} tracks keep their distances and move by {:.3g} px/s, with a jitter of {:.2g} px",
                  d.references, norm(d.drift_px_s), d.jitter_px);
  if (d.finding == StageFinding::drifting)
    out.push_back({"drift",
                   d.removed ? "the stage or the background moves; speeds and mean-square displacements are "
                               "relative to it"
                             : "the stage or the background moves; speeds and mean-square displacements "
                               "include this motion",
                   evidence, d.removed ? "fix the stage for the next video" : "omit --keep-drift",
                   d.removed ? Quality::good : Quality::doubtful});
  if (d.finding == StageFinding::all_rigid)
    out.push_back(
        {"drift",
         "all objects move together and keep their distances: the stage drifts, they are parts of a "
         "textured background, or a swarm swims in formation",
         evidence,
         "record objects that are fixed to the stage, or give the --size of the objects that move"});
}

// Without objects that are fixed to the stage: cells that swim in random directions in a drift have an
// isotropic distribution of velocities about the drift; in a swarm with a common direction it is not
// isotropic, or narrow.
void warn_direction(const TrackMeasurement& m, std::vector<Warning>& out) {
  const TrackSummary& s = m.summary;
  if (m.stage.finding != StageFinding::undecided || supported_walk(s) != SupportedWalk::persistent) return;
  const double drift = std::hypot(s.drift_x_px_s.value, s.drift_y_px_s.value), speed = s.speed_rms_px_s.value;
  const double significance =
      std::hypot(s.drift_x_px_s.value / s.drift_x_px_s.se, s.drift_y_px_s.value / s.drift_y_px_s.se);
  if (!(significance > kSignificantDrift) || drift < kBiasedSpeed * speed || speed < kBiasedSpeed * drift ||
      s.velocity_isotropy < kIsotropic)
    return;
  out.push_back(
      {"drift",
       "a drift of the stage or a flow cannot be distinguished from swimming in one direction: no "
       "objects keep their distances",
       fmt::format("the objects have a common velocity of {:.3g} px/s, and {:.3g} px/s relative to it", drift,
                   speed),
       "record objects that are fixed to the stage"});
}

void warn_misfit(const TrackMeasurement& m, std::vector<Warning>& out) {
  const TrackSummary& s = m.summary;
  const SupportedWalk walk = supported_walk(s);
  if (walk == SupportedWalk::none || !misfit_of(s).significant) return;
  const MsdMisfit& misfit = misfit_of(s);
  const bool diffusion = walk == SupportedWalk::diffusion;
  const bool together = s.order > 0.5 || mean_order(s) > 0.5;
  out.push_back(
      {"model",
       diffusion ? "the mean-square displacement is not that of diffusion, and D has no meaning"
                 : "the mean-square displacement is not that of a persistent walk; its speed and "
                   "persistence time have no meaning",
       fmt::format("it differs by {:+.0f} +- {:.2g} % from the fit at {:.3g} s", 100 * misfit.deviation,
                   100 * misfit.se, misfit.lag_s),
       "look at the curve in --report; use populations, or a part of the video",
       // The speeds of displacements do not depend on a model. Without common motion D is the result.
       diffusion && !together ? Quality::doubtful : Quality::good});
}

}  // namespace

std::vector<Warning> detection_warnings(const TrackDetection& d) {
  std::vector<Warning> out;
  warn_coding(d, out);
  warn_noise(d, out);
  warn_texture(d, out);
  warn_size(d, out);
  return out;
}

std::vector<Warning> track_warnings(const TrackMeasurement& m) {
  if (m.frames < 2)
    return {
        {"frames",
         "a single frame: a texture cannot be distinguished from objects, because it is not known what moves",
         fmt::format("{:.0f} detections", m.detection.spots_per_frame),
         "look at --preview, or give several frames"}};
  std::vector<Warning> out = detection_warnings(m.detection);
  if (m.summary.tracks == 0) {
    out.push_back({"detection", "no objects were tracked, so that nothing was measured",
                   fmt::format("{:.2g} detections per frame", m.detection.spots_per_frame),
                   "look at --preview, and give --size, --threshold or a smaller --least"});
    return out;
  }
  warn_links(m, out);
  warn_scores(m, out);
  warn_motion(m, out);
  warn_stage(m, out);
  warn_direction(m, out);
  warn_misfit(m, out);
  warn_lengths(m, out);
  return out;
}

}  // namespace faba
