#include "study/data/video_frames.h"

#include <algorithm>
#include <cmath>

#include "vision/files/frame_encoder.h"
#include "vision/image/kernels/grey_scale.h"

namespace faba {
namespace {

constexpr double kSameTime = 1e-6;  // s, rounding of times that are computed from time stamps
constexpr double kNear = 16;        // frames that are read on for, instead of seeking (assumed)

}  // namespace

VideoFrames::VideoFrames(const std::filesystem::path& path) : video_(run_video(path)) {
  reader_.emplace(video_.file);
  frames_stated_ = reader_->frames_in_header();
}

std::string VideoFrames::damage() const { return damage_.empty() ? reader_->damage() : damage_; }

VideoFrameRef VideoFrames::at(double t_s) {
  t_s = std::max(0.0, t_s);
  if (shown_ && follows_shown(t_s)) {
    while (!ended_ && ahead_->t_s <= t_s + kSameTime) next();
    return shown_;
  }
  if (!start_before(t_s)) throw Error(Errc::input, video_.file.string(), "no frame can be decoded");
  return shown_;
}

VideoFrameRef VideoFrames::next() {
  if (!shown_) return at(0);
  if (ended_) return nullptr;
  shown_ = std::exchange(ahead_, read());
  ended_ = !ahead_;
  return shown_;
}

VideoFrameRef VideoFrames::last() {
  const double rate = fps() > 0 ? fps() : 1;
  // The length in the header may be that of a truncated file before it was truncated.
  if (frames_stated_ > 1) at(double(frames_stated_ - 1) / rate);
  while (next()) {
  }
  return shown_;
}

// Whether the frame at `t_s` is the shown one, or one of the next.
bool VideoFrames::follows_shown(double t_s) const {
  if (t_s + kSameTime < shown_->t_s) return false;
  if (ended_) return true;
  return t_s <= ahead_->t_s + kNear / (fps() > 0 ? fps() : 1);
}

// Reads the frame at `t_s` into `shown_`, and the next one into `ahead_`. False if there is no frame at all.
bool VideoFrames::start_before(double t_s) {
  for (const double earlier_s : {0.0, 2.0})
    if (reader_->seek(std::max(0.0, t_s - earlier_s)) && read_until(t_s)) return true;
  reopen();
  reader_->skip_to(t_s);
  if (read_until(t_s)) return true;
  reopen();
  shown_ = read();
  ahead_ = shown_ ? read() : nullptr;
  ended_ = !ahead_;
  return shown_ != nullptr;
}

// Converting a frame takes as long as decoding it, so this is done only for the frames that may be the last
// one before `t_s`: those in the last two frame intervals. After a gap in time there may be none; its last
// frame is then read again. Returns false if there is no frame, or only frames after `t_s`.
bool VideoFrames::read_until(double t_s) {
  const double interval = 1 / (fps() > 0 ? fps() : 1);
  shown_ = ahead_ = nullptr;
  double t = 0, before = -1;
  while (reader_->next(t)) {
    if (t > t_s + kSameTime) {
      if (before < 0) return false;
      ahead_ = converted(t);
      break;
    }
    before = t;
    shown_ = t > t_s - 2 * interval ? converted(t) : nullptr;
  }
  ended_ = !ahead_;
  if (shown_ || before < 0) return shown_ != nullptr;
  return before < t_s && start_before(before);
}

VideoFrameRef VideoFrames::read() {
  double t = 0;
  return reader_->next(t) ? converted(t) : nullptr;
}

VideoFrameRef VideoFrames::converted(double t_s) {
  auto frame = std::make_shared<VideoFrame>();
  reader_->picture(frame->grey);
  frame->t_s = t_s;
  frame->index = std::llround(t_s * (fps() > 0 ? fps() : 1));
  return frame;
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
  const double steps = h.most > h.least ? 255.999 / (h.most - h.least) : 0;
  for (const float v : values) ++h.counts[std::size_t((double(v) - h.least) * steps)];
  const auto quantile = [&](double fraction) {
    const auto at = values.begin() + std::ptrdiff_t(fraction * double(values.size() - 1));
    std::nth_element(values.begin(), at, values.end());
    return double(*at);
  };
  h.low = quantile(0.001);
  h.high = quantile(0.999);
  return h;
}

Gray8 looked_at(const GrayF& picture, const FrameLook& look) {
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

std::string looked_at_png(const GrayF& picture, const FrameLook& look) {
  const Gray8 shown = looked_at(picture, look);
  FrameEncoder encoder(FrameEncoder::Kind::png_grey, shown.width, shown.height);
  const auto bytes = encoder.encode(shown);
  return {reinterpret_cast<const char*>(bytes.data()), bytes.size()};
}

}  // namespace faba
