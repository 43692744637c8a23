#include "study/tracks/track_survey.h"

#include <algorithm>
#include <cmath>

#include <fmt/format.h>

#include "core/counted.h"
#include "core/error.h"
#include "core/statistics.h"
#include "vision/image/kernels/all_finite.h"
#include "vision/image/kernels/arithmetic.h"
#include "vision/image/kernels/grey_scale.h"
#include "vision/image/kernels/smoothing.h"

namespace faba {
namespace {

constexpr int kFewFrames = 10;       // smallest number of frames for a temporal median
constexpr double kSizeIfNone = 4;    // px
constexpr int kSmallestRegion = 16;  // px; smallest side
constexpr double kChanging = 1.5;  // temporal over spatial noise: half of the variance is not noise (assumed)
constexpr double kFloorNoise = 0.25;  // smallest noise of a Background, which a coded video has
constexpr std::size_t kGaps = 10000;  // largest number of stored frame intervals

// Polarity of the differences from the surroundings at the scale of cells, 1.5 to 8 px.
Polarity detected_polarity(const GrayF& frame, const Background& b) {
  const GrayF d = difference(frame, b.level);
  GrayF fine = smoothed(d, 1);
  subtract(fine, smoothed(d, 6));
  return polarity_of(fine.px);
}

std::int64_t count_spots(const TrackOptions& o, const TrackSurvey& s, const Background& b,
                         const GrayF& frame) {
  return std::int64_t(Detector(b, detector_options(o, s, {})).find(frame).size());
}

double typical_noise(const Background& b) {
  std::vector<float> noise = b.noise_sd.px;
  return double(robust_spread_low(noise).median);
}

// The temporal statistics of a stationary background are those of its noise. Moving objects cover a pixel in
// a minority of the frames and do not change its median deviation.
void warn_background(TrackSurvey& s, const Background& median, const Background& smooth) {
  const double temporal = typical_noise(median), spatial = typical_noise(smooth);
  if (spatial <= kFloorNoise || temporal < kChanging * spatial) return;
  s.warnings.push_back(
      {"background",
       "the background changes by more than its noise: it has a texture that moves, the light flickers, or "
       "objects "
       "cover most of the picture; detections may be parts of it",
       fmt::format("standard deviation of a pixel over time {:.3g}, between neighbours {:.3g} grey levels",
                   temporal, spatial),
       "look at --preview; give the --size and --threshold of the objects, or a --region"});
}

void choose_background(const TrackOptions& o, TrackSurvey& s, const SurveyedFrames& frames, Pool& pool,
                       SurveyScope scope) {
  const GrayF& middle = frames.middle;
  const Background &median = frames.median, &fine = frames.fine;
  const bool many = s.frames >= kFewFrames;
  const Background& first_guess = many ? median : fine;
  s.polarity = o.polarity == Polarity::automatic ? detected_polarity(middle, first_guess) : o.polarity;
  SpotSize size{o.size_px, {}};
  if (!(size.px > 0)) size = spot_size(middle, first_guess, s.polarity, pool);
  if (!(size.px > 0) && many) size = spot_size(middle, fine, s.polarity, pool);
  s.size_px = size.px;
  s.two_sizes = size.two;
  if (!(s.size_px > 0)) {
    s.size_px = kSizeIfNone;
    s.size_found = false;
  }
  s.smoothing_px = std::max(8.0, 4 * s.size_px);
  Background smooth;
  std::int64_t by_space = 0, by_time = 0, stationary = 0;
  const std::function<void()> counts[] = {
      [&] {
        smooth = spatial_background(middle, s.smoothing_px);
        by_space = count_spots(o, s, smooth, middle);
      },
      [&] { by_time = count_spots(o, s, median, middle); },
      [&] {
        stationary = count_spots(o, s, spatial_background(median.level, s.smoothing_px), median.level);
      }};
  const std::size_t wanted = !many ? 1 : scope == SurveyScope::input ? 2 : std::size(counts);
  pool.run_uneven(wanted, [&](std::size_t i) { counts[i](); });
  s.stationary_spots = stationary;
  if (scope == SurveyScope::all && many && !(o.size_px > 0 && o.threshold_sd > 0))
    warn_background(s, median, smooth);
  s.temporal = o.background == BackgroundKind::median ||
               (o.background == BackgroundKind::automatic && many && 2 * by_time >= by_space);
  s.spots = s.temporal ? by_time : by_space;
  // The temporal background has a noise level for each pixel, used as a weight.
  if (s.temporal)
    s.background = median;
  else
    s.background = std::move(smooth);
}

}  // namespace

void throw_no_frames(const std::filesystem::path& video, const VideoPart& part) {
  if (part.from_s > 0 || part.to_s)
    throw Error(Errc::input, video.string(),
                fmt::format("has no frames from {:g} s to {}; give an earlier --from or a later --to",
                            part.from_s, part.to_s ? fmt::format("{:g} s", *part.to_s) : "its end"));
  throw Error(Errc::input, video.string(), "contains no readable frames");
}

DetectorOptions detector_options(const TrackOptions& o, const TrackSurvey& s,
                                 const std::optional<DropMask>& drop) {
  DetectorOptions d;
  d.size_px = s.size_px;
  d.polarity = s.polarity;
  d.threshold_sd = o.threshold_sd;
  d.coded = s.coding.coded();
  d.drop = drop;
  if (d.drop) d.drop->centre_image = d.drop->centre_image - Vec2{double(s.region.col), double(s.region.row)};
  return d;
}

PixelRegion searched_region(const TrackOptions& o, int width, int height) {
  if (!o.region) return {0, 0, width, height};
  const PixelRegion& r = *o.region;
  const bool inside = r.col >= 0 && r.row >= 0 && r.width <= width - r.col && r.height <= height - r.row;
  if (inside && std::min(r.width, r.height) >= kSmallestRegion) return r;
  throw Error(
      Errc::usage, "--region",
      fmt::format("{},{},{},{}: must be inside of the frames, which have {} x {} px, and at least {} px "
                  "wide and high",
                  r.col, r.row, r.width, r.height, width, height, kSmallestRegion));
}

void make_finite(GrayF& frame) {
  if (all_finite(frame)) return;
  std::vector<float> finite;
  for (const float v : frame.px)
    if (std::isfinite(v)) finite.push_back(v);
  const float fill = finite.empty() ? 0 : robust_spread_low(finite).median;
  for (float& v : frame.px)
    if (!std::isfinite(v)) v = fill;
}

FrameInspector TrackSurveyor::inspector() {
  return {[this](double t_s) { return needs(t_s); },
          [this](const GrayF& frame) -> std::function<void()> {
            take(frame);
            return {};
          }};
}

bool TrackSurveyor::needs(double t_s) {
  if (frames_ == 0) first_s_ = t_s;
  if (frames_ > 0 && t_s > last_s_ && gaps_.size() < kGaps) gaps_.push_back(t_s - last_s_);
  last_s_ = t_s;
  ++frames_;
  if (sampler_.needs_next()) return true;
  sampler_.skip();
  return false;
}

void TrackSurveyor::take(const GrayF& frame) {
  GrayF finite, small;
  const GrayF* used = &frame;
  if (!all_finite(frame)) {
    finite = frame;
    make_finite(finite);
    used = &finite;
  }
  if (side_ > 1) {
    shrink(*used, side_, small);
    used = &small;
  }
  if (frames_ == 1) {
    first_ = *used;
    region_ = searched_region(options_, used->width, used->height);
  }
  sampler_.take(options_.region ? cropped(*used, region_) : *used);
}

SurveyedFrames TrackSurveyor::surveyed(int bits, bool timed, Pool& pool) const {
  SurveyedFrames out;
  TrackSurvey& s = out.survey;
  s.frames = frames_;
  s.timed = timed;
  s.bits = bits;
  s.first = first_;
  s.region = region_;
  s.duration_s = last_s_ - first_s_;
  if (!gaps_.empty()) {
    std::vector<double> gaps = gaps_;
    s.frame_s = median_high(gaps);
  }
  out.middle = sampler_.kept()[sampler_.kept().size() / 2].image();
  const GrayF& middle = out.middle;
  if (side_ == 1) s.coding = coding_traces(sampler_.kept(), pool);
  const std::function<void()> jobs[] = {
      [&] {
        out.fine = spatial_background(middle, std::min(30.0, 0.1 * std::min(middle.width, middle.height)));
      },
      [&] {
        std::vector<float> levels = s.first.px;
        s.black = quantile_low(levels, 0.001);
        s.white = quantile_low(levels, 0.999);
      }};
  pool.run_uneven(std::size(jobs), [&](std::size_t i) { jobs[i](); });
  out.median = sampler_.background(pool);
  return out;
}

TrackSurvey survey_of(const TrackOptions& o, const SurveyedFrames& frames, Pool& pool, SurveyScope scope) {
  TrackSurvey s = frames.survey;
  choose_background(o, s, frames, pool, scope);
  return s;
}

TrackSurvey TrackSurveyor::result(int bits, bool timed, Pool& pool, SurveyScope scope) const {
  return survey_of(options_, surveyed(bits, timed, pool), pool, scope);
}

TrackSurvey survey_tracks(const TrackOptions& o, const std::filesystem::path& video,
                          const std::function<void(std::int64_t, std::int64_t)>& tick, int side) {
  TrackSurveyor surveyor(o, side);
  const VideoReading reading = inspect_video(video, o.part, surveyor.inspector(), o.threads, tick);
  if (surveyor.frames() == 0) throw_no_frames(video, o.part);
  Pool pool(o.threads);
  TrackSurvey s = surveyor.result(reading.bits, reading.timed, pool);
  if (reading.damaged)
    s.notes.push_back(fmt::format("{}: {} could be read; {}", video.string(),
                                  counted(std::uint64_t(s.frames), "frame"), reading.damage));
  if (s.frames == 1) s.notes.emplace_back("one frame only: spots are detected but not tracked");
  if (!s.timed && s.frames > 1)
    s.notes.emplace_back("no frame rate is stated: times are frame counts; specify --fps");
  if (!s.size_found)
    s.notes.push_back(
        fmt::format("no spots above the noise at any size; a size of {} px is assumed", s.size_px));
  if (s.temporal && s.size_found && s.stationary_spots * 4 > s.spots)
    s.notes.push_back(fmt::format(
        "{} of the size of a cell {} excluded as part of the median background: objects that do not move, or "
        "positions that are often occupied; to include them, use --background spatial",
        counted(std::uint64_t(s.stationary_spots), "stationary spot"),
        s.stationary_spots == 1 ? "is" : "are"));
  return s;
}

}  // namespace faba
