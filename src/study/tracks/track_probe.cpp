#include "study/tracks/track_probe.h"

#include <utility>

#include "core/error.h"
#include "study/tracks/spot_sums.h"
#include "study/tracks/track_preview.h"
#include "study/tracks/track_warnings.h"

namespace faba {
namespace {

bool same_spots(const TrackOptions& a, const TrackOptions& b) {
  return a.size_px == b.size_px && a.polarity == b.polarity && a.background == b.background &&
         a.threshold_sd == b.threshold_sd;
}

std::vector<Spot> spots_of(GrayF picture, const Detector& detector, const TrackSurvey& survey) {
  make_finite(picture);
  return spots_in(picture, detector, survey);
}

}  // namespace

TrackProbe::TrackProbe(TrackOptions options, RunVideo source,
                       const std::function<bool(std::int64_t, std::int64_t)>& progress)
    : options_(std::move(options)), source_(std::move(source)), frames_(source_.file, options_.part.fps) {
  VideoReader reader(source_.file, options_.part.fps, 1);
  TrackSurveyor surveyor(options_);
  sample_frames(reader, options_, source_.file, surveyor,
                [&](double, const GrayF&, std::int64_t done, std::int64_t total) {
                  if (!progress(done, total))
                    throw Error(Errc::interrupted, options_.video.string(), "stopped");
                });
  Pool pool(options_.threads);
  surveyed_ = surveyor.surveyed(reader.bits(), reader.fps() > 0, pool);
}

const TrackProbe::Prepared& TrackProbe::prepared(const TrackOptions& o) {
  if (prepared_ && same_spots(prepared_->options, o)) return *prepared_;
  Prepared p;
  p.options = options_;
  p.options.size_px = o.size_px;
  p.options.polarity = o.polarity;
  p.options.background = o.background;
  p.options.threshold_sd = o.threshold_sd;
  Pool pool(options_.threads);
  p.survey = survey_of(p.options, surveyed_, pool);
  const std::optional<DropMask> drop = drop_of(p.options, p.survey);
  p.detector = std::make_unique<Detector>(p.survey.background, detector_options(p.options, p.survey, drop));
  p.detection = detection_of(p.options, p.survey, *p.detector, drop);
  prepared_ = std::move(p);
  return *prepared_;
}

ProbedFrame TrackProbe::detect(const TrackOptions& o, std::int64_t index) {
  const std::lock_guard lock(mutex_);
  const IndexedFrame f = frames_.frame(index);
  const Prepared& p = prepared(o);
  ProbedFrame out;
  out.index = index;
  out.t_s = f.t_s;
  out.spots = spots_of(*f.picture, *p.detector, p.survey);
  out.detection = p.detection;
  SpotSums sums;
  sums.take(out.spots);
  sums.describe(out.detection);
  out.warnings = p.survey.warnings;
  const std::vector<Warning> found = detection_warnings(out.detection);
  out.warnings.insert(out.warnings.end(), found.begin(), found.end());
  return out;
}

ProbedLinks TrackProbe::link(const TrackOptions& o, std::int64_t first, int count) {
  const std::lock_guard lock(mutex_);
  std::vector<IndexedFrame> frames{frames_.frame(first)};
  while (int(frames.size()) < count) {
    auto f = frames_.find(first + std::int64_t(frames.size()));
    if (!f) break;
    frames.push_back(*std::move(f));
  }
  const Prepared& p = prepared(o);
  std::vector<std::vector<Spot>> spots(frames.size());
  Pool pool(options_.threads);
  pool.run_uneven(frames.size(),
                  [&](std::size_t i) { spots[i] = spots_of(*frames[i].picture, *p.detector, p.survey); });
  Tracker tracker(o.tracker);
  double last_s = -1;
  for (std::size_t i = 0; i < frames.size(); ++i) {
    if (!(frames[i].t_s > last_s)) continue;
    last_s = frames[i].t_s;
    tracker.take(std::uint64_t(frames[i].index), frames[i].t_s, spots[i]);
  }
  tracker.finish();
  return {first,
          int(frames.size()),
          tracker.finished(),
          tracker.search_radius_px(),
          tracker.motion(),
          tracker.crowded()};
}

}  // namespace faba
