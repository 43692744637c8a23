#include "study/identify/response/response_survey.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>

#include "app/recording/session.h"
#include "core/error.h"
#include "core/threads/ordered_work.h"
#include "study/data/run_info.h"
#include "study/data/run_video.h"
#include "study/identify/found_segments.h"
#include "study/identify/matched_look.h"
#include "study/motion/direction_text.h"
#include "study/stats/statistics.h"
#include "study/tracks/track_survey.h"
#include "vision/cells/stationary_cells.h"
#include "vision/cells/tracker.h"
#include "vision/cells/video_ground.h"
#include "vision/files/grey_video.h"

namespace faba {
namespace {

constexpr double kResolved = 0.8;  // fraction of the cells detected singly; above it their positions are used
constexpr double kMinSegment = 0.2;         // s
constexpr double kMinBurstFrames = 12;      // a burst of eight within the measured part of a segment
constexpr double kMaxWidth = 5;             // px: wider cells are reduced by averaging
constexpr double kMinRelativeSnr = 0.25;    // of the 90 % quantile of the signal-to-noise ratio
constexpr double kMinPath = 0.1;            // of a moving swarm, fraction of the view
constexpr double kDirectionTolerance = 60;  // degrees
constexpr double kCoverage = 0.85;  // quantile over the frames: a pixel may be covered by cells that often
constexpr double kReach = 2;        // times the displacement in the video
constexpr double kWhite = 255;
constexpr double kSameScale = 1e-3;  // relative

// Positions of single cells if most are resolved; otherwise as many positions as the estimated number of
// cells, distributed like the signal.
std::vector<Vec2> positions_in(const GrayF& frame, const CellView& view, Measure measure) {
  const Foreground foreground = view.foreground_in(frame);
  const double cells = foreground.moments().cells;
  std::vector<Vec2> positions;
  for (const Spot& s : view.detector().find(frame)) positions.push_back({s.x_px, s.y_px});
  if (measure == Measure::tracks || double(positions.size()) >= kResolved * cells) return positions;
  positions.clear();
  const GrayF& w = foreground.weights();
  double sum = 0;
  for (const float x : w.px) sum += std::max(0.0, double(x));
  const int n = std::max(1, int(std::lround(cells)));
  double next = 0.5 * sum / n, cumulative = 0;
  for (int r = 0; r < w.height; ++r)
    for (int c = 0; c < w.width; ++c) {
      cumulative += std::max(0.0, double(w.at(c, r)));
      for (; cumulative > next && int(positions.size()) < n; next += sum / n)
        positions.push_back({double(c), double(r)});
    }
  return positions;
}

// Reorders positions by the golden-ratio sequence, so that every leading part is distributed like all of
// them: a simulation with fewer cells uses the first ones, one with more cells repeats the first ones.
std::vector<Vec2> low_discrepancy_order(const std::vector<Vec2>& positions) {
  constexpr double kGolden = 0.6180339887498949;
  std::vector<std::size_t> order(positions.size());
  std::iota(order.begin(), order.end(), std::size_t(0));
  const auto key = [](std::size_t k) { return std::fmod(kGolden * double(k), 1.0); };
  std::sort(order.begin(), order.end(), [&](std::size_t a, std::size_t b) { return key(a) < key(b); });
  std::vector<Vec2> mixed;
  mixed.reserve(order.size());
  for (const std::size_t k : order) mixed.push_back(positions[k]);
  return mixed;
}

/// Field segments from the centroid of the swarm in each frame.
std::vector<FieldSegment> segments_of_drop(const ResponseVideo& v, const std::function<void()>& tick) {
  const VideoPart& part = v.input.part;
  GreyVideo video(v.file, part.fps, v.side);
  std::vector<double> t_s;
  std::vector<Vec2> centroid;
  GrayF frame;
  if (part.from_s > 0) video.skip_to(part.from_s);
  for (double t = 0; video.read(frame, t) && !part.ends_before(t); tick()) {
    if (!part.holds(t)) continue;
    const SwarmMoments m = v.view.foreground_in(frame).moments();
    t_s.push_back(t);
    centroid.push_back(m.signal > 0 ? m.centroid_image : Vec2{std::nan(""), std::nan("")});
  }
  return segments_of_swarm(t_s, centroid, kMinPath * std::min(v.view.width, v.view.height));
}

/// Field segments that a run recorded; empty for a video without a run and for a run without a field record.
std::vector<FieldSegment> recorded_segments(const std::filesystem::path& run) {
  if (!is_run(run) || !std::filesystem::exists(run / "series.csv")) return {};
  return segments_of_field(read_series(run / "series.csv"),
                           read_run_info(run / run_files::kManifest).polarity == "south");
}

// `end_s`: last time of the part of the video that is used.
std::vector<FieldSegment> segments_in(const ResponseVideo& v, const std::vector<FieldSegment>& recorded,
                                      Boundary boundary, double end_s, const std::function<void()>& tick) {
  const ResponseInput& in = v.input;
  if (!in.segments.empty()) return in.segments;
  const double end =
      in.duration_s && in.reversal_s ? std::min(*in.reversal_s + *in.duration_s, end_s) : end_s;
  if (in.reversal_s && in.direction_deg) return {{*in.reversal_s, end, *in.direction_deg}};
  std::vector<FieldSegment> found =
      !recorded.empty() ? recorded
      : boundary == Boundary::none
          ? segments_of_motion(v.file, in.part, v.side > 1 ? v.side : 0, in.threads, tick)
          : segments_of_drop(v, tick);
  if (in.direction_deg)
    std::erase_if(found, [&](const FieldSegment& d) {
      return std::fabs(std::remainder(d.direction_deg - *in.direction_deg, 360)) > kDirectionTolerance;
    });
  for (FieldSegment& d : found) {  // the run may have recorded more than the part of its video that is used
    d.t0_s = std::max(d.t0_s, in.part.from_s);
    if (in.part.to_s) d.t1_s = std::min(d.t1_s, end_s);
  }
  std::erase_if(found,
                [&](const FieldSegment& d) { return d.t1_s <= std::max(d.t0_s, in.reversal_s.value_or(0)); });
  if (found.empty())
    throw Error(Errc::input, in.file.string(),
                "no motion in one direction detected; give reversal and direction, or [[video.segment]]");
  if (in.reversal_s) found.front().t0_s = *in.reversal_s;
  if (in.duration_s) {
    const double until = found.front().t0_s + *in.duration_s;
    std::erase_if(found, [&](const FieldSegment& d) { return d.t0_s >= until; });
    found.back().t1_s = std::min(found.back().t1_s, until);
  }
  return found;
}

// Without a boundary cells enter and leave the view, so each segment is an episode with new initial
// positions.
std::vector<Episode> episodes_of(const ResponseVideo& v, Boundary boundary,
                                 const std::vector<FieldSegment>& segments) {
  std::vector<Episode> episodes;
  for (FieldSegment d : segments) {
    if (boundary == Boundary::none || episodes.empty()) {
      Episode& e = episodes.emplace_back();
      // Simulations begin at the frame in which the initial positions are measured.
      e.start_s = std::round(d.t0_s * v.fps) / v.fps;
      e.name = v.input.experiment.empty() ? v.input.file.stem().string() : v.input.experiment;
      if (boundary == Boundary::none && segments.size() > 1) e.name += fmt::format(", {:.3g} s", e.start_s);
    }
    Episode& e = episodes.back();
    d.t0_s -= e.start_s;
    d.t1_s -= e.start_s;
    e.segments.push_back(d);
  }
  return episodes;
}

// Difference of the cells in a frame from the background, in units of its light: the 90 % quantile of the
// pixels that differ by more than five standard deviations of the noise.
double cell_contrast(const GrayF& frame, const VideoBackground& ground, Polarity polarity) {
  std::vector<double> differences;
  for (std::size_t i = 0; i < frame.px.size(); ++i) {
    const double brighter = double(frame.px[i]) / kWhite - double(ground.light.px[i]);
    const double d = polarity == Polarity::bright ? brighter : -brighter;
    if (d > 5 * ground.noise_sd) differences.push_back(d);
  }
  return differences.empty() ? 1 : quantile(differences, 0.9);
}

std::shared_ptr<const Background> background_of(const VideoBackground& ground) {
  Background b{ground.light, GrayF(ground.light.width, ground.light.height), 0};
  for (float& x : b.level.px) x *= float(kWhite);
  std::fill(b.noise_sd.px.begin(), b.noise_sd.px.end(), float(std::max(0.25, ground.noise_sd * kWhite)));
  return std::make_shared<const Background>(std::move(b));
}

// Background and noise. With Measure::density the background is a high (or low) quantile over time, because
// dense groups cover the same pixels most of the time; with Measure::tracks everything that does not move is
// background.
void estimate_background(ResponseVideo& v, const GrayF& first, Measure measure, double from_s, double to_s,
                         const std::function<void()>& tick) {
  VideoBackgroundOptions o;
  o.fps = v.input.part.fps;
  o.side = v.side;
  o.threads = v.input.threads;
  o.tick = tick;
  if (measure == Measure::density)
    o.quantile = v.view.cells.polarity == Polarity::bright ? 1 - kCoverage : kCoverage;
  o.from_s = from_s - 0.5 * v.view.frame_s;
  o.to_s = to_s + 0.5 * v.view.frame_s;
  VideoBackground ground = read_video_background(v.file, o);
  v.view.background = background_of(ground);
  // Stationary cells would be invisible in front of themselves, and simulated ones are not. If no cell is
  // visible in front of the background, nothing moves, which is an error later.
  if (measure == Measure::density && !v.view.detector().find(first).empty()) {
    const Polarity polarity = v.view.cells.polarity;
    const double contrast = cell_contrast(first, ground, polarity);
    v.stationary = remove_stationary_cells(ground.light, v.view.cells.cell_px, contrast, polarity);
    v.view.background = background_of(ground);
  }
  v.ground = std::make_shared<const VideoBackground>(std::move(ground));
}

// Background, noise, appearance of the cells, and boundary.
TrackSurvey survey_view(ResponseVideo& v, Boundary boundary, Measure measure,
                        const std::function<void()>& tick) {
  const std::string name = v.input.file.string();
  TrackOptions options;
  options.video = v.input.file;
  options.part = v.input.part;
  options.threads = v.input.threads;
  const auto survey = [&] {
    return survey_tracks(
        options, v.file, [&](auto, auto) { tick(); }, v.side);
  };
  TrackSurvey s = survey();
  if (s.frames < 3) throw Error(Errc::input, name, "fewer than three frames");
  if (!s.timed) throw Error(Errc::input, name, "frame rate unknown; give fps");
  if (!s.size_found) throw Error(Errc::input, name, "no cells detected: no signal above the noise");
  v.side = std::max(1, int(s.size_px / kMaxWidth));
  if (v.side > 1) {
    v.notes.push_back(fmt::format("cells are {:.3g} px wide: frames are averaged over squares of {} px",
                                  s.size_px, v.side));
    s = survey();
  }
  v.um_per_px *= v.side;
  v.fps = 1 / s.frame_s;
  v.view.width = s.first.width;
  v.view.height = s.first.height;
  v.view.frame_s = s.frame_s;
  v.view.cells.cell_px = std::clamp(s.size_px, 1.0, 20.0);
  v.view.cells.polarity = s.polarity == Polarity::bright ? Polarity::bright : Polarity::dark;
  estimate_background(v, s.first, measure, v.input.part.from_s, v.input.part.from_s + s.duration_s, tick);
  if (boundary == Boundary::drop) {
    DropEdgeOptions edge;
    edge.name = name;
    // In the background, because cells that gather at the edge would shift it by about a pixel.
    v.edge = find_drop_edge(v.view.background->level, edge);
  }
  // Notes on spot detection refer to options of `track` and do not apply here.
  std::erase_if(s.notes,
                [](const std::string& note) { return note.find("--background") != std::string::npos; });
  v.notes.insert(v.notes.end(), s.notes.begin(), s.notes.end());
  return s;
}

// Parameters for tracking single cells: a threshold, because much fainter spots are dirt or far out of focus,
// and a reach that also covers faster simulated cells.
void set_tracking(ResponseVideo& v, const std::vector<GrayF>& frames) {
  const Detector detector = v.view.detector();
  std::vector<std::vector<Spot>> spots;
  std::vector<double> snr;
  for (const GrayF& f : frames) {
    spots.push_back(detector.find(f));
    for (const Spot& s : spots.back()) snr.push_back(s.snr);
  }
  v.view.threshold_sd =
      std::max(detector.threshold_sd(), snr.empty() ? 0 : kMinRelativeSnr * quantile(snr, 0.9));
  double count = 1;
  for (auto& one : spots) {
    std::erase_if(one, [&](const Spot& s) { return s.snr < v.view.threshold_sd; });
    count += double(one.size()) / double(frames.size());
  }
  const double spacing = std::sqrt(double(v.view.width) * v.view.height / count);
  v.view.search_radius_px = std::min(kReach * estimated_search_radius(spots), 0.75 * spacing);
}

void check_segments(const std::vector<FieldSegment>& segments, const ResponseInput& input, Measure measure,
                    const TrackSurvey& survey) {
  const double shortest = measure == Measure::tracks ? kMinBurstFrames * survey.frame_s : kMinSegment;
  const double from = input.part.from_s, to = from + survey.duration_s;
  for (const FieldSegment& d : segments)
    if (!(d.t1_s - d.t0_s >= shortest) || d.t0_s < from - survey.frame_s || d.t1_s > to + survey.frame_s)
      throw Error(
          Errc::input, input.file.string(),
          fmt::format("field segment from {:.4g} to {:.4g} s is invalid; it must last at least "
                      "{:.2g} s and lie within the part of the video that is used, {:.4g} to {:.4g} s",
                      d.t0_s, d.t1_s, shortest, from, to));
}

// Reads all needed frames in one pass: initial positions, statistics, pictures for the report.
void take_frames(ResponseVideo& v, Boundary boundary, Measure measure, const std::function<void()>& tick) {
  std::vector<double> times_s;
  const auto add_times = [&](const Episode& e, const std::vector<double>& times) {
    for (const double t : times) times_s.push_back(e.start_s + t);
  };
  for (const Episode& e : v.episodes) {
    add_times(e, {0});
    add_times(e, make_statistics(measure, e, v.view)->times_s());
    add_times(e, picture_times(e));
  }
  std::vector<GrayF> frames = frames_at(v, times_s, tick);
  if (measure == Measure::tracks) set_tracking(v, frames);
  auto next = frames.begin();
  for (Episode& e : v.episodes) {
    const GrayF first = std::move(*next++);
    e.positions_image = low_discrepancy_order(positions_in(first, v.view, measure));
    if (e.positions_image.empty())
      throw Error(Errc::input, v.input.file.string(),
                  fmt::format("no cells in motion detected at {:.3g} s", e.start_s));
    v.statistics.push_back(make_statistics(measure, e, v.view));
    const auto measured_end = next + std::ptrdiff_t(v.statistics.back()->times_s().size());
    const std::vector<GrayF> measured(std::make_move_iterator(next), std::make_move_iterator(measured_end));
    next = measured_end + std::ptrdiff_t(picture_times(e).size());
    v.pictures.emplace_back(std::make_move_iterator(measured_end), std::make_move_iterator(next));
    // Cells are resolved best in the middle of an episode, when the swarm is spread out.
    if (v.contrast == 0) match_look(v, measured[measured.size() / 2], boundary);
    v.observed.push_back(v.statistics.back()->of_frames(measured));
  }
}

}  // namespace

std::vector<GrayF> frames_at(const ResponseVideo& v, const std::vector<double>& times_s,
                             const std::function<void()>& tick) {
  GreyVideo video(VideoReader(v.file, v.input.part.fps, OrderedWork::threads(v.input.threads)), v.side);
  std::vector<GrayF> frames(times_s.size());
  std::vector<double> off(times_s.size(), std::numeric_limits<double>::infinity());
  const double last = times_s.empty() ? 0 : *std::max_element(times_s.begin(), times_s.end());
  GrayF frame;
  if (v.input.part.from_s > 0) video.skip_to(v.input.part.from_s);
  for (double t = 0; video.read(frame, t) && t <= last + 1;) {
    tick();
    if (!v.input.part.holds(t)) continue;
    for (std::size_t i = 0; i < times_s.size(); ++i)
      if (const double d = std::fabs(t - times_s[i]); d < off[i]) {
        frames[i] = frame;
        off[i] = d;
      }
  }
  return frames;
}

std::vector<double> picture_times(const Episode& e) {
  const double length = e.segments.front().t1_s;
  return {0.15 * length, 0.5 * length, length};
}

ResponseVideo survey_response(const ResponseInput& input, Boundary boundary, Measure measure,
                              const std::function<void()>& tick) {
  ResponseVideo v;
  v.input = input;
  const RunVideo source = run_video(input.file);
  v.file = source.file;
  const std::optional<double> scale = input.um_per_px ? input.um_per_px : source.scale.um_per_px;
  if (!scale)
    throw Error(Errc::input, input.where.empty() ? input.file.string() : input.where,
                fmt::format("picture scale of {} unknown; set um_per_px of this [[video]], or scale = "
                            "\"calibration.toml\" at the top of the study",
                            input.file.filename().string()));
  v.um_per_px = *scale;
  if (const auto& stated = source.scale.um_per_px; stated && std::fabs(*scale / *stated - 1) > kSameScale) {
    v.recorded_um_per_px = stated;
    v.notes.push_back(fmt::format(
        "recorded picture scale {:g} um per pixel; {:g} um per pixel of the study is used", *stated, *scale));
  }
  const TrackSurvey survey = survey_view(v, boundary, measure, tick);

  const std::vector<FieldSegment> recorded = recorded_segments(input.file);
  const std::vector<FieldSegment> segments =
      segments_in(v, recorded, boundary, input.part.from_s + survey.duration_s, tick);
  for (const FieldSegment& d : recorded) v.field_t = std::max(v.field_t.value_or(0), d.field_t.value_or(0));
  v.segments_detected =
      recorded.empty() && input.segments.empty() && !(input.reversal_s && input.direction_deg);
  check_segments(segments, input, measure, survey);
  if (v.segments_detected) {
    std::string all;
    for (const FieldSegment& d : segments)
      all += fmt::format("{}{:.2f} to {:.2f} s at {}", all.empty() ? "" : ", ", d.t0_s, d.t1_s,
                         direction_text(d.direction_deg));
    v.notes.push_back("field segments were detected in the video; all results depend on them: " + all);
  }
  v.episodes = episodes_of(v, boundary, segments);
  // Outside the segments the swarm may stay in one position for most of the time: estimate again within them.
  if (measure == Measure::density && (segments.front().t0_s > input.part.from_s + 0.2 * survey.duration_s ||
                                      segments.back().t1_s < input.part.from_s + 0.8 * survey.duration_s))
    estimate_background(v, survey.first, measure, segments.front().t0_s, segments.back().t1_s, tick);
  if (v.stationary > 0)
    v.notes.push_back(
        fmt::format("stationary spots of the width of a cell: {}; they are counted as cells that are not "
                    "motile, also if they are dirt",
                    v.stationary));

  take_frames(v, boundary, measure, tick);
  return v;
}

}  // namespace faba
