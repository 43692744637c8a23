#include "study/tracks/swarm_view.h"

#include <algorithm>
#include <cmath>

#include "core/error.h"
#include "core/statistics.h"
#include "study/data/run_video.h"
#include "study/data/series.h"
#include "vision/files/video_reader.h"
#include "vision/flow/flow_file.h"

namespace faba {
namespace {

constexpr std::int64_t kFramesCounted = 50;

ForegroundOptions options_of(const TrackSurvey& s) {
  ForegroundOptions o;
  o.cell_px = std::clamp(s.size_px, 1.0, 20.0);
  o.polarity = s.polarity == Polarity::both ? Polarity::automatic : s.polarity;
  o.learn = s.temporal;  // else each frame has its own background
  return o;
}

void multiply(GrayF& frame, float by) {
  for (float& v : frame.px) v *= by;
}

// Number of visible cells recorded by the simulation.
std::optional<double> counted_by_run(const std::filesystem::path& run, const VideoPart& part) {
  const Series series = read_series(run / "series.csv");
  const auto counts = series.find("visible_count"), times = series.column("t_s");
  double sum = 0, n = 0;
  for (std::size_t i = 0; i < counts.size(); ++i)
    if (std::isfinite(counts[i]) && part.holds(times[i])) {
      sum += counts[i];
      n += 1;
    }
  return n > 0 ? std::optional(sum / n) : std::nullopt;
}

}  // namespace

SwarmView::SwarmView(const TrackSurvey& survey, int bits) : foreground_(options_of(survey)) {
  // The scale keeps black at 0, so that the absorbed fraction of the light is preserved.
  if (bits > 8 && survey.white > 0) scale_ = 255 / survey.white;
  std::vector<float> noise = survey.background.noise_sd.px;
  noise_ = double(scale_ * robust_spread_low(noise).median);
  if (!survey.temporal) return;
  Background b = survey.background;
  multiply(b.level, scale_);
  foreground_.set_background(b);
}

SwarmMoments SwarmView::take(const GrayF& frame, double t_s) {
  GrayF grey = frame;
  if (scale_ != 1) multiply(grey, scale_);
  foreground_.take(grey, noise_, t_s - last_s_);
  last_s_ = t_s;
  return foreground_.moments();
}

std::optional<double> visible_cells(const std::filesystem::path& path, const VideoPart& part,
                                    const std::function<bool()>& keep_running) {
  if (is_run(path) && !has_camera_video(path)) return counted_by_run(path, part);
  const std::filesystem::path video = run_video(path).file;
  if (FlowFileReader::recognises(video)) return {};
  const auto check = [&] {
    if (!keep_running()) throw Error(Errc::interrupted, path.string(), "stopped");
  };
  TrackOptions options;
  options.video = video;
  options.fps = part.fps;
  const TrackSurvey survey = survey_tracks(options, video, [&](auto, auto) { check(); });
  VideoReader reader(video, part.fps);
  const Detector detector(survey.background, detector_options(options, survey, {}));
  const double length = std::min(part.to_s.value_or(survey.duration_s), survey.duration_s) - part.from_s;
  const double fraction = survey.duration_s > 0 ? std::clamp(length / survey.duration_s, 0.0, 1.0) : 1;
  const std::int64_t step =
      std::max<std::int64_t>(1, std::int64_t(fraction * double(survey.frames)) / kFramesCounted);
  GrayF frame;
  double t_s = 0, cells = 0, n = 0;
  for (std::int64_t index = 0; reader.read(frame, t_s); ++index) {
    check();
    if (index % step != 0 || !part.holds(t_s)) continue;
    make_finite(frame);
    cells += double(survey.temporal ? detector.find(frame).size()
                                    : Detector(spatial_background(frame, survey.smoothing_px),
                                               detector_options(options, survey, {}))
                                          .find(frame)
                                          .size());
    n += 1;
  }
  return n > 0 ? std::optional(cells / n) : std::nullopt;
}

}  // namespace faba
