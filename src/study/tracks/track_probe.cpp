#include "study/tracks/track_probe.h"

#include <fmt/format.h>

#include <algorithm>
#include <utility>

#include "core/error.h"
#include "study/tracks/spot_sums.h"
#include "study/tracks/track_preview.h"
#include "study/tracks/track_warnings.h"
#include "vision/files/frame_encoder.h"

namespace faba {
namespace {

constexpr std::size_t kMostRecentBytes = 128u << 20;

bool same_spots(const TrackOptions& a, const TrackOptions& b) {
  return a.size_px == b.size_px && a.polarity == b.polarity && a.background == b.background &&
         a.threshold_sd == b.threshold_sd;
}

}  // namespace

TrackProbe::TrackProbe(TrackOptions options, RunVideo source,
                       const std::function<bool(std::int64_t, std::int64_t)>& progress)
    : options_(std::move(options)), source_(std::move(source)) {
  VideoReader reader(source_.file, options_.part.fps, 1);
  stated_ = reader.frames_in_header();
  fps_ = reader.fps();
  TrackSurveyor surveyor(options_);
  sample_frames(reader, options_, source_.file, surveyor,
                [&](double, const GrayF&, std::int64_t done, std::int64_t total) {
                  if (!progress(done, total))
                    throw Error(Errc::interrupted, options_.video.string(), "stopped");
                });
  Pool pool(options_.threads);
  frames_ = surveyor.surveyed(reader.bits(), reader.fps() > 0, pool);
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
  p.survey = survey_of(p.options, frames_, pool);
  const std::optional<DropMask> drop = drop_of(p.options, p.survey);
  p.detector = std::make_unique<Detector>(p.survey.background, detector_options(p.options, p.survey, drop));
  p.detection = detection_of(p.options, p.survey, *p.detector, drop);
  prepared_ = std::move(p);
  return *prepared_;
}

// After it the reader reads the frame `index` next, or is at the end. Frames are skipped by their time if the
// video has a constant frame rate, otherwise one by one.
void TrackProbe::go_to(std::int64_t index) {
  const auto open = [&] {
    reader_ = std::make_unique<VideoReader>(source_.file, options_.part.fps, 1);
    next_ = 0;
  };
  if (!reader_ || next_ > index) open();
  if (fps_ > 0 && index > next_) next_ += reader_->skip_to((double(index) - 0.5) / fps_);
  if (next_ > index) open();
  for (double t_s = 0; next_ < index && reader_->next(t_s);) ++next_;
}

std::optional<TrackProbe::Frame> TrackProbe::find_frame(std::int64_t index) {
  const auto known =
      std::find_if(recent_.begin(), recent_.end(), [&](const Frame& f) { return f.index == index; });
  if (known != recent_.end()) return *known;
  go_to(index);
  Frame f;
  f.index = index;
  if (next_ != index || !reader_->next(f.t_s)) {
    reader_.reset();
    return {};
  }
  ++next_;
  auto picture = std::make_shared<GrayF>();
  reader_->picture(*picture);
  make_finite(*picture);
  const std::size_t bytes = std::max<std::size_t>(1, picture->px.size() * sizeof(float));
  f.picture = std::move(picture);
  while (!recent_.empty() && (recent_.size() + 1) * bytes > kMostRecentBytes) recent_.pop_front();
  recent_.push_back(f);
  return f;
}

TrackProbe::Frame TrackProbe::frame(std::int64_t index) {
  if (index >= 0)
    if (auto f = find_frame(index)) return *std::move(f);
  throw Error(Errc::input, options_.video.filename().string(),
              fmt::format("has no frame {}; the first frame is 0", index));
}

ProbedFrame TrackProbe::detect(const TrackOptions& o, std::int64_t index) {
  const std::lock_guard lock(mutex_);
  const Frame f = frame(index);
  const Prepared& p = prepared(o);
  ProbedFrame out;
  out.index = index;
  out.t_s = f.t_s;
  out.spots = spots_in(*f.picture, *p.detector, p.survey);
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
  std::vector<Frame> frames{frame(first)};
  while (int(frames.size()) < count) {
    auto f = find_frame(first + std::int64_t(frames.size()));
    if (!f) break;
    frames.push_back(*std::move(f));
  }
  const Prepared& p = prepared(o);
  std::vector<std::vector<Spot>> spots(frames.size());
  Pool pool(options_.threads);
  pool.run_uneven(frames.size(),
                  [&](std::size_t i) { spots[i] = spots_in(*frames[i].picture, *p.detector, p.survey); });
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

std::vector<std::uint8_t> TrackProbe::png(std::int64_t index) {
  std::shared_ptr<const GrayF> picture;
  {
    const std::lock_guard lock(mutex_);
    picture = frame(index).picture;
  }
  const float black = frames_.survey.black, white = std::max(black + 1e-6f, frames_.survey.white);
  Gray8 shown(picture->width, picture->height);
  std::transform(picture->px.begin(), picture->px.end(), shown.px.begin(), [&](float v) {
    return std::uint8_t(std::clamp(255 * (v - black) / (white - black), 0.0f, 255.0f));
  });
  FrameEncoder encoder(FrameEncoder::Kind::png_grey, shown.width, shown.height);
  const auto bytes = encoder.encode(shown);
  return {bytes.begin(), bytes.end()};
}

}  // namespace faba
