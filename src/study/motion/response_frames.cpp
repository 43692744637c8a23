#include "study/motion/response_frames.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>
#include <utility>
#include <vector>

#include "core/error.h"
#include "core/statistics.h"
#include "core/threads/ordered_work.h"
#include "study/data/frame_inspector.h"
#include "study/tracks/track_survey.h"
#include "vision/cells/detector.h"
#include "vision/drop/drop_search.h"
#include "vision/foreground/kernels/line_closing.h"
#include "vision/image/kernels/arithmetic.h"
#include "vision/image/kernels/grey_scale.h"

namespace faba {
namespace {

constexpr int kSampled = 40;        // frames of the median
constexpr double kDefaultSize = 4;  // px, as DetectorOptions: when no spot is significant
constexpr double kSmoothing = 8;    // px: scale of the illumination, for the polarity
// Length of the closing segment over the size of an object. A cell that stays beside the dark edge of a drop
// is filled up to the level at the ends of a segment that leads from the edge through the cell: of a short
// one this level is nearly that of the cell, which then counts too little. Assumed.
constexpr double kShortSizes = 6, kLongSizes = 10;
constexpr double kSagitta = 0.15;  // px, of a straight segment on the edge of a drop. Assumed
// Values that belong to the background: within this number of standard deviations of the noise and half a
// step of 8 bits of its median.
constexpr double kBackgroundSd = 3, kHalfStep = 0.5;
// Of the median light: where it is darker, noise is not amplified more. Assumed.
constexpr double kLeastLight = 0.3;

GrayF scaled(GrayF frame, float by) {
  multiply(frame, by);
  return frame;
}

// Factors from a difference to the background to one relative to the light there, in units of the median
// light.
GrayF per_light(const GrayF& background) {
  std::vector<float> levels(background.px);
  const float middle = median_low(levels);
  GrayF out = background;
  for (float& v : out.px) v = middle > 0 ? middle / std::max(v, float(kLeastLight) * middle) : 1.0F;
  return out;
}

// The median of pictures, refined by the mean of their values near it: a median of integers is an integer,
// and where the light differs little its rounding has the form of wide objects.
void refine(Background& median, const std::vector<CompactImage>& pictures, Pool& pool) {
  constexpr std::size_t kPixelsPerBlock = 1 << 12;
  GrayF& level = median.level;
  pool.for_blocks(level.px.size(), kPixelsPerBlock, [&](std::size_t begin, std::size_t end) {
    std::vector<float> sums(end - begin), counts(end - begin), greys(end - begin);
    for (const CompactImage& picture : pictures) {
      picture.copy(begin, end - begin, greys.data());
      for (std::size_t i = begin; i < end; ++i) {
        const float d = greys[i - begin] - level.px[i];
        const bool near = std::fabs(d) < float(kBackgroundSd) * median.noise_sd.px[i] + float(kHalfStep);
        sums[i - begin] += near ? d : 0.0F;
        counts[i - begin] += near ? 1.0F : 0.0F;
      }
    }
    for (std::size_t i = begin; i < end; ++i)
      level.px[i] += sums[i - begin] / std::max(counts[i - begin], 1.0F);
  });
}

// The edge of a drop, if one is detected.
std::optional<Circle> edge_in(const GrayF& background) {
  const DropEdgeOptions options;
  try {
    const auto edge = search_drop_edge(prepare_drop_picture(background, options), options).accepted;
    return edge ? std::optional(edge->circle) : std::nullopt;
  } catch (const Error& e) {
    if (e.code() != Errc::input) throw;
    return {};  // the picture is uniform or small
  }
}

// The background with small objects filled. On the edge of a drop the segments are shorter, so that they
// leave it by kSagitta and it does not count as objects; the shortest ones are bent as an edge that they
// would leave by half a pixel.
GrayF filled(const GrayF& background, const std::optional<Circle>& edge, double size_px, Pool& pool) {
  const double radius = edge ? edge->radius : std::numeric_limits<double>::infinity();
  const double flat = 2 * std::sqrt(2 * kSagitta * radius);
  const double length = std::max(3.0, std::clamp(flat, kShortSizes * size_px, kLongSizes * size_px));
  return line_closing(background, length, pool, radius).least;
}

// Averages over squares of `side` px.
GrayF reduced(const GrayF& frame, int side) {
  GrayF small;
  if (side == 1)
    small = frame;
  else
    shrink(frame, side, small);
  make_finite(small);
  return small;
}

}  // namespace

FrameInspector ResponsePictures::inspector() {
  return {[this](double t_s) {
            t_s_ = t_s;
            return kept_ && part_.holds(t_s);
          },
          [this](const GrayF& frame) -> std::function<void()> {
            pictures_.push_back({t_s_, CompactImage(reduced(frame, side_))});
            kept_ = pictures_.size() * bytes_ <= most_bytes_;  // else the file has more frames than it states
            if (!kept_) pictures_.clear();
            return {};
          },
          [this](const VideoReader& video) { begin(video); }};
}

void ResponsePictures::begin(const VideoReader& video) {
  const int width = video.width(), height = video.height();
  side_ = std::max(1, (std::max(width, height) + kLongResponseSide - 1) / kLongResponseSide);
  bytes_ = sizeof(float) * std::size_t(width / side_) * std::size_t(height / side_);
  const std::int64_t stated = frames_stated(video, part_);
  kept_ = stated > 0 && std::size_t(stated) * bytes_ <= most_bytes_;
}

bool ResponsePictures::hold(const VideoPart& part) const {
  constexpr double kEnd = std::numeric_limits<double>::infinity();
  return kept_ && !pictures_.empty() && part.from_s >= part_.from_s && part.fps == part_.fps &&
         part.to_s.value_or(kEnd) <= part_.to_s.value_or(kEnd);
}

ResponseFrames::ResponseFrames(std::filesystem::path video, const VideoPart& part, unsigned threads,
                               std::function<void()> check, std::shared_ptr<ResponsePictures> pictures)
    : video_(std::move(video)),
      threads_(OrderedWork::threads(threads)),
      check_(std::move(check)),
      pictures_(std::move(pictures)) {
  BackgroundSampler sampler(kSampled);
  pictures_ && pictures_->hold(part) ? take(part, sampler) : read_all(part, sampler);
  if (frames_ == 0) throw Error(Errc::input, video_.string(), "no frame in this part of the video");
  Pool pool(threads_);
  Background median = sampler.background(pool);
  std::vector<float> noise(median.noise_sd.px);
  noise_ = double(median_low(noise));
  const GrayF middle = sampler.kept()[sampler.kept().size() / 2].image();
  const Background smooth = spatial_background(middle, kSmoothing);
  std::vector<float> differences(middle.px.size());
  for (std::size_t i = 0; i < differences.size(); ++i) differences[i] = middle.px[i] - smooth.level.px[i];
  const Polarity polarity = polarity_of(differences);
  sign_ = polarity == Polarity::dark ? 1 : -1;
  size_ = spot_size(middle, median, polarity, pool).px;
  if (!(size_ > 0)) size_ = spot_size(middle, smooth, polarity, pool).px;
  if (!(size_ > 0)) size_ = kDefaultSize;
  refine(median, sampler.kept(), pool);
  const GrayF level = scaled(std::move(median.level), float(sign_));
  edge_ = edge_in(level);
  filled_ = filled(level, edge_, size_, pool);
  if (polarity == Polarity::dark) gain_ = per_light(filled_);
  still_ = objects_in(scaled(level, float(sign_)));
}

// The background of pictures in memory.
void ResponseFrames::take(const VideoPart& part, BackgroundSampler& sampler) {
  for (const ResponsePictures::Picture& p : pictures_->all()) {
    if (!part.holds(p.t_s)) continue;
    ++frames_;
    if (sampler.needs_next())
      sampler.take(p.grey.image());
    else
      sampler.skip();
  }
}

// Reads the part, for the background and, if they are kept, all pictures.
void ResponseFrames::read_all(const VideoPart& part, BackgroundSampler& sampler) {
  if (!pictures_) pictures_ = std::make_shared<ResponsePictures>(part);
  *pictures_ = pictures_->of(part);
  const FrameInspector sampling{[&](double) {
                                  ++frames_;
                                  const bool needed = sampler.needs_next();
                                  if (!needed) sampler.skip();
                                  return needed;
                                },
                                [&](const GrayF& frame) -> std::function<void()> {
                                  sampler.take(reduced(frame, side()));
                                  return {};
                                }};
  inspect_video(video_, part, both(pictures_->inspector(), sampling), threads_,
                [&](auto, auto) { check_(); });
}

GrayF ResponseFrames::objects_in(GrayF picture) const {
  GrayF out = difference(filled_, scaled(std::move(picture), float(sign_)));
  if (!gain_.empty()) multiply(out, gain_);
  return out;
}

std::size_t ResponseFrames::slots() const { return OrderedWork::slots(threads_); }

void ResponseFrames::read(const VideoPart& part, const std::function<void(std::size_t, GrayF&, double)>& work,
                          const std::function<void(std::size_t)>& take) const {
  VideoReader reader(video_, part.fps, threads_);
  if (part.from_s > 0) reader.skip_to(part.from_s);
  std::vector<GrayF> frames(slots());
  std::vector<double> times_s(slots());
  const auto next = [&](std::size_t slot) {
    double& t_s = times_s[slot];
    while (reader.next(t_s) && !part.ends_before(t_s)) {
      if (!part.holds(t_s)) continue;
      reader.picture(frames[slot]);
      return true;
    }
    return false;
  };
  const auto on_frame = [&](std::size_t slot, unsigned) { work(slot, frames[slot], times_s[slot]); };
  OrderedWork pictures(threads_, {next, on_frame});
  while (const std::optional<std::size_t> slot = pictures.next()) {
    check_();
    take(*slot);
  }
}

void ResponseFrames::each(const VideoPart& part,
                          const std::function<void(std::size_t, const GrayF&, double)>& work,
                          const std::function<void(std::size_t)>& take) const {
  if (!pictures_->hold(part)) {
    read(
        part,
        [&](std::size_t slot, GrayF& frame, double t_s) {
          work(slot, objects_in(reduced(frame, side())), t_s);
        },
        take);
    return;
  }
  using Picture = ResponsePictures::Picture;
  const std::vector<Picture>& kept = pictures_->all();
  std::vector<const Picture*> pictures(slots());
  std::size_t at = 0;
  const auto next = [&](std::size_t slot) {
    while (at < kept.size() && !part.holds(kept[at].t_s)) ++at;
    if (at == kept.size()) return false;
    pictures[slot] = &kept[at++];
    return true;
  };
  const auto on_picture = [&](std::size_t slot, unsigned) {
    work(slot, objects_in(pictures[slot]->grey.image()), pictures[slot]->t_s);
  };
  OrderedWork all(threads_, {next, on_picture});
  while (const std::optional<std::size_t> slot = all.next()) {
    check_();
    take(*slot);
  }
}

}  // namespace faba
