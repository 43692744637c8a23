#include "study/response_video.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>

#include "core/error.h"
#include "study/run_video.h"
#include "study/swarm_view.h"
#include "study/track_survey.h"
#include "vision/detector.h"
#include "vision/grey_scale.h"
#include "vision/video_reader.h"

namespace faba {
namespace {

constexpr double kOwnWidth = 0.85;  // diameter of a cell over the width that it is seen with
constexpr double kResolved =
    0.8;  // share of the cells that are seen one by one, from which on their places count
constexpr double kShortestDrive = 0.2;  // s

/// The frames of a video that are nearest to given moments, greys of 0 to 255.
std::vector<GrayF> frames_at(const ResponseVideo& v, const std::vector<double>& times_s,
                             const std::function<void()>& tick) {
  VideoReader reader(v.file, v.input.fps);
  std::vector<GrayF> frames(times_s.size());
  std::vector<double> off(times_s.size(), std::numeric_limits<double>::infinity());
  std::optional<GreyScale> greys;
  GrayF frame;
  for (double t = 0; reader.read(frame, t);) {
    if (!greys) greys.emplace(reader.bits(), frame);
    tick();
    bool scaled = false;
    for (std::size_t i = 0; i < times_s.size(); ++i)
      if (const double d = std::fabs(t - times_s[i]); d < off[i]) {
        if (!scaled) greys->apply(frame), scaled = true;
        frames[i] = frame, off[i] = d;
      }
    if (!times_s.empty() && t > times_s.back() + 1) break;
  }
  return frames;
}

// Cells one by one where they can be told apart; where not, as many places as there are cells, spread as what
// is seen.
std::vector<Vec2> places_in(const GrayF& frame, const Background& background, const ResponseVideo& v,
                            double noise) {
  Foreground foreground(v.cells);
  foreground.know(background);
  foreground.take(frame, noise, 1);
  const double cells = foreground.moments().cells;
  DetectorOptions d;
  d.size_px = v.cells.cell_px,
  d.polarity = v.cells.polarity == Polarity::bright ? Polarity::bright : Polarity::dark;
  std::vector<Vec2> places;
  for (const Spot& s : Detector(background, d).find(frame)) places.push_back({s.x_px, s.y_px});
  if (double(places.size()) >= kResolved * cells) return places;
  places.clear();
  const GrayF& w = foreground.weights();
  double sum = 0;
  for (const float x : w.px) sum += std::max(0.0, double(x));
  const int n = std::max(1, int(std::lround(cells)));
  double due = 0.5 * sum / n, so_far = 0;
  for (int r = 0; r < w.height; ++r)
    for (int c = 0; c < w.width; ++c) {
      so_far += std::max(0.0, double(w.at(c, r)));
      for (; so_far > due && int(places.size()) < n; due += sum / n) places.push_back({double(c), double(r)});
    }
  return places;
}

// What one cell does to the light, as the contrast of [microscope]: from all that is seen over the number of
// cells.
double contrast_of(const SwarmMoments& m, const Background& background, const ForegroundOptions& cells) {
  double level = 0;
  for (const float x : background.level.px) level += double(x) / double(background.level.px.size());
  const double diameter = kOwnWidth * cells.cell_px, area = std::numbers::pi / 4 * diameter * diameter;
  const double density = m.signal / std::max(1.0, m.cells) / std::max(1.0, level) / area;
  return cells.polarity == Polarity::bright ? std::min(density, 10.0) : std::max(std::expm1(-density), -0.95);
}

}  // namespace

ResponseVideo survey_response(const ResponseInput& input, Boundary boundary,
                              const std::function<void()>& tick) {
  ResponseVideo v;
  v.input = input;
  const RunVideo source = run_video(input.file);
  v.file = source.file;
  const std::optional<double> scale = input.um_per_px ? input.um_per_px : source.um_per_px;
  if (!scale)
    throw Error(Errc::input, input.file.string(), "has no scale; give um_per_px, or a calibration file");
  v.um_per_px = *scale;

  TrackOptions options;
  options.video = input.file, options.fps = input.fps;
  const TrackSurvey survey = survey_tracks(options, v.file, [&](auto, auto) { tick(); });
  if (survey.frames < 3) throw Error(Errc::input, input.file.string(), "has fewer than three frames");
  if (!survey.timed) throw Error(Errc::input, input.file.string(), "states no frame rate; give fps");
  v.fps = 1 / survey.frame_s, v.width = survey.first.width, v.height = survey.first.height;
  v.ground = std::make_shared<const VideoGround>(read_video_ground(v.file));
  v.cells.cell_px = std::clamp(survey.size_px, 1.0, 20.0);
  v.cells.polarity = survey.polarity == Polarity::bright ? Polarity::bright : Polarity::dark;
  if (boundary == Boundary::drop) {
    DropEdgeOptions edge;
    edge.name = input.file.string();
    v.edge = find_drop_edge(survey.first, edge);
  }

  std::vector<Drive> drives = input.drives;
  if (drives.empty()) {
    if (!input.reversal_s || !input.direction_deg)
      throw Error(Errc::input, input.file.string(), "give reversal and direction, or [[video.drive]]");
    const double end = input.duration_s ? *input.reversal_s + *input.duration_s : survey.duration_s;
    drives.push_back({*input.reversal_s, std::min(end, survey.duration_s), *input.direction_deg});
  }
  for (const Drive& d : drives)
    if (!(d.t1_s - d.t0_s >= kShortestDrive) || d.t1_s > survey.duration_s + survey.frame_s)
      throw Error(Errc::input, input.file.string(),
                  fmt::format("a drive from {:g} to {:g} s is too short, or beyond the video's {:g} s",
                              d.t0_s, d.t1_s, survey.duration_s));
  // With nothing to hold them cells leave the view and others come: each drive then begins with what is seen.
  std::vector<std::vector<Drive>> parts;
  for (const Drive& d : drives)
    if (boundary == Boundary::none || parts.empty())
      parts.push_back({d});
    else
      parts.back().push_back(d);

  std::vector<float> noise_px = survey.background.noise_sd.px;
  const double noise = double(robust_spread(noise_px).median);
  for (const auto& part : parts) {
    Episode e;
    e.begins_s = part.front().t0_s;
    e.name = input.experiment.empty() ? input.file.stem().string() : input.experiment;
    if (parts.size() > 1) e.name += fmt::format(", {:.3g} s", e.begins_s);
    for (Drive d : part) {
      d.t0_s -= e.begins_s, d.t1_s -= e.begins_s;
      e.drives.push_back(d);
    }
    const EpisodeStatistics statistics(e, v.width, v.height, v.cells);
    std::vector<double> moments{e.begins_s};
    for (const double t : statistics.times_s()) moments.push_back(e.begins_s + t);
    std::vector<GrayF> frames = frames_at(v, moments, tick);
    e.places_image = places_in(frames.front(), survey.background, v, noise);
    if (e.places_image.empty())
      throw Error(Errc::input, input.file.string(), fmt::format("shows no cells that move at {:.3g} s", e.begins_s));
    if (v.episodes.empty()) {
      Foreground foreground(v.cells);
      foreground.know(survey.background);
      foreground.take(frames.back(), noise, 1);
      SwarmMoments m = foreground.moments();
      if (!(m.cells >= 3)) foreground.take(frames.front(), noise, 1), m = foreground.moments();
      v.contrast = contrast_of(m, survey.background, v.cells);
    }
    frames.erase(frames.begin());
    v.observed.push_back(statistics.of_frames(frames));
    v.episodes.push_back(std::move(e));
  }
  v.notes = survey.notes;
  return v;
}

}  // namespace faba
