#include "study/motion/activity.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>

#include "core/statistics.h"
#include "core/units.h"
#include "study/data/run_info.h"
#include "study/data/run_video.h"
#include "study/motion/activity_checks.h"
#include "study/motion/direction_text.h"
#include "study/motion/video_response.h"
#include "study/tracks/cell_count.h"

namespace faba {
namespace {

constexpr std::size_t kBlocks = 6;     // blocks of a video whose flows are assumed independent
constexpr double kResponds = 4;        // standard errors
constexpr double kEdgeFraction = 0.1;  // fraction of the fitted peak at the start and end of a response

void check_stop(const ActivityJob& job, const ActivityInput& v) {
  if (job.stop()) throw Error(Errc::interrupted, v.file.string(), "stopped; no output was written");
}

double detected_direction(const VideoActivity& a) {
  double longest = -1, deg = 0;
  for (const MotionSegment& s : a.segments)
    if (s.t1_s - s.t0_s > longest) {
      longest = s.t1_s - s.t0_s;
      deg = s.direction_deg;
    }
  if (longest >= 0) return deg;
  Vec2 all{0, 0};
  for (std::size_t k = 0; k < a.signature.size(); ++k) all = all + a.signature.sum(k);
  return direction_of(all);
}

// The maximum, and the time after it at which the fitted curve is a tenth of its height, inside the video.
void mark_points(VideoActivity& a) {
  if (!a.fit.good) return;
  a.maximum_s = a.fit.peak_s;
  const double half_width = a.fit.sigma_s * std::sqrt(-2 * std::log(kEdgeFraction));
  if (a.fit.peak_s + half_width < a.t_s.back()) a.departure_s = a.fit.peak_s + half_width;
}

bool reversal_is_known(const VideoActivity& a) {
  return a.response && a.response->source != Response::Source::detected;
}

// Whether anything moves in one direction: else a maximum of the activity is a fluctuation, and its standard
// error, which assumes a peak, is meaningless. A file of flows with a given direction has only its activity.
bool directed(const VideoActivity& a) {
  if (a.response) return a.response->responds || !a.segments.empty();
  if (a.direction_given) return true;
  return !a.segments.empty();
}

// The expectation of the flow across the direction is zero: its means over blocks give the standard error of
// a mean.
double signal_to_noise(const VideoActivity& a) {
  const Signature& s = a.signature;
  const Vec2 across{-std::sin(a.direction_deg * kDegree), std::cos(a.direction_deg * kDegree)};
  if (s.size() < 2 * kBlocks) return 0;  // too short
  double squares = 0, block = 0;
  for (std::size_t k = 0; k < s.size(); ++k) {
    block += dot(s.sum(k), across);
    if ((k + 1) * kBlocks / s.size() == k * kBlocks / s.size()) continue;
    squares += block * block;
    block = 0;
  }
  const double total = a.mean_along * double(s.size()), error = std::sqrt(squares);
  if (error > 0) return total / error;
  return total == 0 ? 0 : std::copysign(std::numeric_limits<double>::infinity(), total);
}

FlowSourceOptions source_options(const ActivityJob& job, const ActivityInput& v) {
  return {.method = job.method,
          .shrink = job.shrink,
          .t0_s = v.from_s,
          .t1_s = v.to_s,
          .fps = job.fps,
          .options_text = job.options_text,
          .frames = job.frames,
          .threads = job.threads};
}

/// One video between the two readings of its frames: the first determines the noise of the flow and the
/// appearance of the cells, the second computes all flows, counts the cells and takes the pictures in which
/// the response is measured.
struct Prepared {
  double threshold_px = 0;
  bool quiet = true;
  std::optional<CellCount> cells;
  std::shared_ptr<KeptFlows> flows;
  std::shared_ptr<ResponsePictures> pictures;
};

ResponseJob response_job(const ActivityJob& job, const ActivityInput& v) {
  return {.video = v.file,
          .part = {v.from_s, v.to_s, job.fps},
          .reversal_s = v.reversal_s,
          .direction_deg = v.direction_deg,
          .threads = job.threads,
          .check = [&] { check_stop(job, v); }};
}

NoiseLevel noise_of(const ActivityJob& job, const ActivityInput& video, std::size_t index,
                    const FrameInspector& inspect, const std::shared_ptr<KeptFlows>& flows) {
  FlowSourceOptions options = source_options(job, video);
  options.inspect = inspect;
  options.kept = flows;
  return noise_level(video.file, options, [&](std::uint64_t done, std::uint64_t total) {
    job.progress(index, done, total);
    check_stop(job, video);
  });
}

// Ends the first reading. Flows that are read from a file have no frames: these are read here.
void end_survey(CellCount& cells, const FrameInspector& survey, const std::function<void()>& check) {
  if (!cells.reads_frames()) return;
  if (!cells.surveys_frames()) cells.read(survey, check);
  cells.end_survey();
}

CellCount cells_of(const ActivityJob& job, const ActivityInput& v) {
  return {v.file, VideoPart{v.from_s, v.to_s, job.fps}, job.threads};
}

Prepared prepare(const ActivityJob& job, std::size_t index, bool measure_noise) {
  const ActivityInput& video = job.videos[index];
  Prepared p;
  FrameInspector survey;
  // Of several videos only one at a time is kept in memory, which takes a further reading of the others.
  if (job.cells && job.videos.size() == 1) {
    p.cells.emplace(cells_of(job, video));
    survey = p.cells->survey();
  }
  if (measure_noise) {
    p.flows = std::make_shared<KeptFlows>();
    const NoiseLevel level = noise_of(job, video, index, survey, p.flows);
    p.threshold_px = level.threshold_px;
    p.quiet = level.quiet;
  }
  if (p.cells) end_survey(*p.cells, survey, [&] { check_stop(job, video); });
  return p;
}

// Sets the signature, the pair of frames with the largest motion, the number of cells and the notes of the
// source.
void read_signature(VideoActivity& a, const ActivityJob& job, std::size_t index, Prepared& prepared) {
  CellCount* const cells = prepared.cells ? &*prepared.cells : nullptr;
  const double zero = a.input.direction_deg.value_or(0);
  a.signature = Signature(a.threshold_px, zero);
  FlowSourceOptions options = source_options(job, a.input);
  if (cells) options.inspect = cells->count();
  if (prepared.pictures) options.inspect = both(options.inspect, prepared.pictures->inspector());
  options.kept = std::move(prepared.flows);
  FlowSource source(a.input.file, options);
  FlowPair pair;
  LightChange light;
  double most = -1;
  while (source.next(pair)) {
    a.signature.add(pair, source.shrink());
    const std::size_t k = a.signature.size() - 1;
    const double now = a.direction_given ? a.signature.along(k, zero) : norm(a.signature.sum(k));
    if (now > most) {
      most = now;
      a.busiest = pair;
      a.busiest_deg = direction_of(a.signature.sum(k));
    }
    light.add(pair.image);
    job.progress(index, k + 1, source.pairs());
    check_stop(job, a.input);
  }
  if (auto warning = light_warning(light, source.shrink(), a.threshold_px)) a.warnings.push_back(*warning);
  a.notes = source.notes();
  a.scale = source.scale();
  a.timed = source.fps() > 0;
  if (a.input.scale) a.scale = *a.input.scale;
  a.um_per_px = a.scale.um_per_px;
  if (a.um_per_px && a.scale.standard_error)
    a.notes.push_back(
        fmt::format("the scale is {:.4g} um/px with a standard error of {:.2g} um/px ({}); intervals of "
                    "speeds in um/s include it",
                    *a.um_per_px, *a.scale.standard_error, a.scale.source));
  a.view_px = double(source.width()) * source.height() * source.shrink() * source.shrink();
  if (!cells) return;
  if (cells->reads_frames() && !cells->mean())
    cells->read(options.inspect, [&] { check_stop(job, a.input); });
  a.visible_cells = cells->mean();
}

void warn_of_flow(VideoActivity& a) {
  if (a.response && a.response->flow) {
    const FlowVerdict& v = *a.response->flow;
    if (v.valid()) return;
    a.warnings.push_back(
        {"frame_rate",
         "the optical flow has no direction: objects move by more than twice their width between frames. The "
         "activity is an index only; speed and responding fraction are measured by image correlation",
         fmt::format(
             "{:.3g} px between frames, width {:.2g} px{}", v.shift_px, v.object_px,
             v.neighbour_px ? fmt::format(", {:.3g} px to the nearest neighbour", *v.neighbour_px) : ""),
         fmt::format("use {:.0f} frames per second or more to measure the direction of the flow",
                     std::ceil(v.shift_px / (2 * v.object_px) / a.frame_s))});
    return;
  }
  if (a.segments.empty() && a.fit.good && (!a.direction_given || *a.signal_to_noise < kResponds))
    a.warnings.push_back(
        {"frame_rate",
         "there is activity but no directed motion: the optical flow of cells that move by more than twice "
         "their width between frames has no direction",
         fmt::format("the activity changes with time, but at no time has half of the flow one direction; "
                     "{:.3g} s per frame",
                     a.frame_s),
         "use a higher frame rate, or give the time of the field reversal with --reversal", Quality::poor});
}

void note_response(VideoActivity& a) {
  if (!a.response) return;
  const Response& r = *a.response;
  if (auto warning = no_response_warning(r)) a.warnings.push_back(*warning);
  if (auto warning = edge_warning(r)) a.warnings.push_back(*warning);
  if (!r.responds)
    a.notes.push_back(
        fmt::format("no response: the velocity along {} does not change significantly (t = {:.2g}; a sample "
                    "without a response exceeds the limit once in {:.0f} videos)",
                    direction_text(r.direction_deg), r.change.t_statistic, 1 / kFalseResponse));
  else if (r.source == Response::Source::detected)
    a.notes.emplace_back(
        "the time of the field reversal is unknown: the onset is that of the first detected motion; give "
        "--reversal");
}

void note_motion(VideoActivity& a) {
  warn_of_flow(a);
  if (!a.responds)
    if (auto warning = opposite_warning(a.signature, a.direction_deg)) a.warnings.push_back(*warning);
  note_response(a);
  if (a.signature.still())
    a.notes.emplace_back("no motion was detected");
  else if (!a.direction_given)
    a.notes.push_back(
        a.segments.empty()
            ? fmt::format("no direction was given and no directed motion was detected; the direction of the "
                          "total flow is used: {}",
                          direction_text(a.direction_deg))
            : fmt::format("no direction was given; the direction of the longest detected motion is used: "
                          "{}",
                          direction_text(a.direction_deg)));
}

void take_response(VideoActivity& a, const ActivityJob& job, std::shared_ptr<ResponsePictures> pictures) {
  ResponseJob response = response_job(job, a.input);
  response.frame_s = a.frame_s;
  response.pictures = std::move(pictures);
  if (a.visible_cells && *a.visible_cells >= 2) response.objects = a.visible_cells;
  a.response = video_response(response, {a.signature, a.segments, a.direction_deg});
  if (!a.response) return;
  if (is_run(a.input.file) && !a.input.scale)
    a.um_per_px = read_run_info(a.input.file / "manifest.json").um_per_px;
  // Nearest-neighbour distance of points at random, for the mean number in view.
  if (a.response->flow && a.visible_cells && *a.visible_cells >= 2)
    a.response->flow->neighbour_px = 0.5 * std::sqrt(a.view_px / *a.visible_cells);
}

VideoActivity measure(const ActivityJob& job, std::size_t index, Prepared& prepared) {
  VideoActivity a;
  a.input = job.videos[index];
  a.threshold_px = prepared.threshold_px;
  a.direction_given = a.input.direction_deg.has_value();
  if (job.cells && !prepared.cells) {
    prepared.cells.emplace(cells_of(job, a.input));
    end_survey(*prepared.cells, prepared.cells->survey(), [&] { check_stop(job, a.input); });
  }
  if (job.responses) prepared.pictures = response_pictures(response_job(job, a.input));
  read_signature(a, job, index, prepared);
  a.segments = motion_segments(a.signature, a.input.direction_deg);
  a.direction_deg = a.direction_given ? *a.input.direction_deg : detected_direction(a);
  const double cone = a.signature.nearest_deg(a.direction_deg);
  for (std::size_t k = 0; k < a.signature.size(); ++k) {
    a.t_s.push_back(a.signature.t_s(k));
    a.amount.push_back(a.signature.amount(k, cone));
    a.along.push_back(a.signature.along(k, cone));
    a.mean_amount += a.amount.back();
    a.mean_along += a.along.back();
  }
  a.mean_amount /= double(a.t_s.size());
  a.mean_along /= double(a.t_s.size());
  std::vector<double> gaps;
  for (std::size_t k = 0; k < a.signature.size(); ++k)
    gaps.push_back(a.signature.t1_s(k) - a.signature.t0_s(k));
  a.frame_s = median_high(gaps);
  a.fit = fit_gaussian(a.t_s, a.amount);
  if (job.responses) take_response(a, job, std::move(prepared.pictures));
  if (a.fit.good && job.responses && !directed(a)) {
    a.fit.good = false;
    a.fit.reason = "nothing moves in one direction, so that a maximum is a fluctuation";
  }
  mark_points(a);
  if (a.direction_given) a.signal_to_noise = signal_to_noise(a);
  a.responds = reversal_is_known(a) ? a.response->responds
                                    : has_peak(a) || (a.direction_given ? *a.signal_to_noise >= kResponds
                                                                        : !a.segments.empty());
  note_motion(a);
  return a;
}

}  // namespace

std::vector<ActivityInput> threshold_inputs(const ActivityJob& job) {
  if (job.threshold_px) return {};
  if (!job.noise.empty()) return {{.file = job.noise}};
  return job.videos.size() > 1 ? job.videos : std::vector<ActivityInput>();
}

double threshold_of(const ActivityJob& job, const ActivityInput& video) {
  std::size_t index = 0;  // for the progress
  while (index + 1 < job.videos.size() && job.videos[index].file != video.file) ++index;
  return noise_of(job, video, index, {}, nullptr).threshold_px;
}

// One threshold for all videos, so that their activities are comparable.
std::optional<double> common_threshold(const ActivityJob& job, const std::vector<double>& thresholds) {
  if (job.threshold_px) return job.threshold_px;
  if (thresholds.empty()) return {};
  double least = 1e300;
  for (const double t : thresholds)
    if (t > 0) least = std::min(least, t);  // black videos have no noise and are ignored
  return least < 1e300 ? least : thresholds.front();
}

VideoActivity measure_video(const ActivityJob& job, std::size_t index, std::optional<double> threshold_px) {
  Prepared prepared = prepare(job, index, !threshold_px);
  if (threshold_px) prepared.threshold_px = *threshold_px;
  check_stop(job, job.videos[index]);
  VideoActivity a = measure(job, index, prepared);
  if (!prepared.quiet && !a.signature.still())
    a.warnings.push_back(
        {"threshold",
         fmt::format("no part of the video is without motion: the threshold of {:.3g} px per pair contains "
                     "motion of cells, and slower motion is not counted",
                     prepared.threshold_px),
         "the mean flow speed in the quietest 10 % of the sampled pairs of frames is at least half of that "
         "in the busiest ones, the 95 % quantile",
         "measure the threshold in a video of a dead sample with --noise, or set it with "
         "--flow-threshold"});
  return a;
}

ActivityResult measure_activity(const ActivityJob& job) {
  std::vector<double> thresholds;
  for (const ActivityInput& video : threshold_inputs(job)) {
    thresholds.push_back(threshold_of(job, video));
    check_stop(job, video);
  }
  const std::optional<double> threshold = common_threshold(job, thresholds);
  std::vector<VideoActivity> videos;
  for (std::size_t i = 0; i < job.videos.size(); ++i) videos.push_back(measure_video(job, i, threshold));
  return activity_result(std::move(videos), job.group);
}

}  // namespace faba
