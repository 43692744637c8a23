#include "study/data/video_frames.h"

#include <algorithm>
#include <cmath>
#include <iterator>
#include <utility>
#include <vector>

#include "core/error.h"
#include "vision/files/frame_encoder.h"
#include "vision/image/kernels/grey_scale.h"

namespace faba {
namespace {

constexpr std::size_t kMostIntervals = 256;
constexpr double kSameTime = 1e-6;  // s, rounding of times that are computed from time stamps
constexpr double kNearFrames = 16;  // frames that are read on for, instead of seeking (assumed)
constexpr std::size_t kMostKnown = 12, kMostKnownBytes = std::size_t{48} << 20;

}  // namespace

VideoFrames::VideoFrames(const std::filesystem::path& path) : VideoFrames(run_video(path)) {}

VideoFrames::VideoFrames(RunVideo video) : video_(std::move(video)) {
  reader_.emplace(video_.file);
  frames_stated_ = reader_->frames_in_header();
  interval_s_ = 1 / (fps() > 0 ? fps() : 1);
  const std::size_t frame_bytes = sizeof(float) * std::size_t(width()) * std::size_t(height());
  most_known_ = std::clamp<std::size_t>(kMostKnownBytes / frame_bytes, 2, kMostKnown);
}

std::string VideoFrames::damage() const { return damage_.empty() ? reader_->damage() : damage_; }

std::size_t VideoFrames::bytes() const {
  constexpr std::size_t kDecoder = 4;  // frames, assumed
  return (most_known_ + kDecoder) * sizeof(float) * std::size_t(width()) * std::size_t(height());
}

VideoFrameRef VideoFrames::at(double t_s) {
  t_s = std::max(0.0, t_s);
  shown_ = nullptr;
  if (covers(t_s)) {
    while (known_.back()->t_s <= t_s + kSameTime && read_on()) {
    }
  } else if (!start_before(t_s)) {
    throw Error(Errc::input, video_.file.string(), "no frame can be decoded");
  }
  show(t_s);
  return shown_;
}

VideoFrameRef VideoFrames::next() {
  if (!shown_) return at(0);
  if (shown_ == known_.back() && !read_on()) return nullptr;
  shown_ = *std::next(std::find(known_.begin(), known_.end(), shown_));
  return shown_;
}

VideoFrameRef VideoFrames::last() {
  // The length in the header may be that of the file before it was truncated.
  if (frames_stated_ > 1) at(double(frames_stated_ - 1) * interval_s_);
  while (next()) {
  }
  return shown_;
}

// Whether the frame at `t_s` is known, or one of the next.
bool VideoFrames::covers(double t_s) const {
  if (known_.empty() || t_s + kSameTime < known_.front()->t_s) return false;
  return ended_ || t_s <= known_.back()->t_s + kNearFrames * interval_s_;
}

// Shows the last known frame that is not after `t_s`, or the first one.
void VideoFrames::show(double t_s) {
  const auto after = std::find_if(known_.begin(), known_.end(),
                                  [&](const VideoFrameRef& f) { return f->t_s > t_s + kSameTime; });
  shown_ = after == known_.begin() ? known_.front() : *std::prev(after);
}

// Reads the frame at `t_s` and the next one into `known_`. False if there is no frame at all.
bool VideoFrames::start_before(double t_s) {
  for (const double earlier_s : {0.0, 2.0})
    if (reader_->seek(std::max(0.0, t_s - earlier_s)) && read_until(t_s, true)) return true;
  // The last key frame may be damaged, so no frame is skipped.
  if (reader_->seek(last_readable(t_s)) && read_until(t_s, false)) return true;
  reopen();
  if (read_until(t_s, false)) return true;
  reopen();
  known_.clear();
  ended_ = false;
  return read_on();
}

// A time before `t_s`, to about a second, at which a frame can be read, if none can be read at `t_s`: the
// file may be truncated before it.
double VideoFrames::last_readable(double t_s) {
  double readable = 0, missing = t_s, t = 0;
  while (missing - readable > std::max(1.0, kNearFrames * interval_s_)) {
    const double middle = (readable + missing) / 2;
    (reader_->seek(middle) && reader_->next(t) ? readable : missing) = middle;
  }
  return readable;
}

// Converting a frame takes as long as decoding it, so this is done only for the last frames before `t_s`;
// with `skip`, frames before the last key frame are not even decoded. After a gap in time there may be none;
// the frame before it is then read again. Returns false if there is no frame, or only frames after `t_s`.
bool VideoFrames::read_until(double t_s, bool skip) {
  known_.clear();
  shown_ = nullptr;
  ended_ = false;
  const double first_s = t_s - double(most_known_ - 1) * interval_s_;
  if (skip) reader_->skip_to(first_s);
  double t = 0, before = -1;
  while (reader_->next(t)) {
    const bool after = t > t_s + kSameTime;
    if (after && before < 0) return false;
    if (after || t > first_s) add_converted(t);
    if (after) break;
    before = t;
  }
  if (before < 0) return false;
  ended_ = known_.empty() || known_.back()->t_s <= t_s + kSameTime;
  const bool found = !known_.empty() && known_.front()->t_s <= t_s + kSameTime;
  return found || (before < t_s && start_before(before));
}

bool VideoFrames::read_on() {
  double t = 0;
  if (ended_ || !reader_->next(t)) {
    ended_ = true;
    return false;
  }
  add_converted(t);
  return true;
}

void VideoFrames::add_converted(double t_s) {
  auto frame = std::make_shared<VideoFrame>();
  reader_->picture(frame->grey);
  frame->t_s = t_s;
  frame->index = std::llround(t_s / interval_s_);
  known_.push_back(frame);
  if (known_.size() > most_known_) known_.pop_front();
}

void VideoFrames::reopen() {
  damage_ = damage();
  reader_.emplace(video_.file);
}

GreyHistogram grey_histogram(const GrayF& picture) {
  GreyHistogram h;
  std::vector<float> values;
  std::copy_if(picture.px.begin(), picture.px.end(), std::back_inserter(values),
               [](float v) { return std::isfinite(v); });
  if (values.empty()) return h;
  const auto [least, most] = std::minmax_element(values.begin(), values.end());
  h.least = double(*least);
  h.most = double(*most);
  const bool integers = std::all_of(values.begin(), values.end(), [](float v) { return v == std::floor(v); });
  const double range = h.most - h.least;
  h.step = integers ? std::ceil((range + 1) / kMostIntervals) : std::max(range, 1e-30) / kMostIntervals;
  h.counts.resize(std::min(std::size_t(range / h.step) + 1, kMostIntervals));
  for (const float v : values)
    ++h.counts[std::min(std::size_t((double(v) - h.least) / h.step), h.counts.size() - 1)];
  const auto quantile = [&](double fraction) {
    const auto at = values.begin() + std::ptrdiff_t(fraction * double(values.size() - 1));
    std::nth_element(values.begin(), at, values.end());
    return double(*at);
  };
  h.low = quantile(0.001);
  h.high = quantile(0.999);
  return h;
}

Gray8 displayed_frame(const GrayF& picture, const FrameLook& look) {
  const int most = look.width > 0 ? look.width : picture.width;
  const int side = std::min((picture.width + most - 1) / most, std::min(picture.width, picture.height));
  GrayF binned;
  if (side > 1) shrink(picture, side, binned);
  const GrayF& source = side > 1 ? binned : picture;
  Gray8 out(source.width, source.height);
  const auto low = float(look.low), gain = float(255 / std::max(1e-9, look.high - look.low));
  std::transform(source.px.begin(), source.px.end(), out.px.begin(), [&](float v) {
    const float level = (v - low) * gain + 0.5F;
    return std::uint8_t(level > 0 ? std::min(level, 255.0F) : 0.0F);  // 0 if not a number
  });
  return out;
}

std::string displayed_png(const GrayF& picture, const FrameLook& look) {
  const Gray8 shown = displayed_frame(picture, look);
  FrameEncoder encoder(FrameEncoder::Kind::png_grey, shown.width, shown.height);
  const auto bytes = encoder.encode(shown);
  return {reinterpret_cast<const char*>(bytes.data()), bytes.size()};
}

}  // namespace faba
