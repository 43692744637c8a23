#include "study/tracks/indexed_frames.h"

#include <fmt/format.h>

#include <algorithm>
#include <utility>

#include "core/error.h"

namespace faba {
namespace {

constexpr std::size_t kMostRecentBytes = 64u << 20;

}  // namespace

IndexedFrames::IndexedFrames(std::filesystem::path video, double fps)
    : video_(std::move(video)),
      asked_fps_(fps),
      reader_(std::make_unique<VideoReader>(video_, asked_fps_, 1)) {
  fps_ = reader_->fps();
  width_ = reader_->width();
  height_ = reader_->height();
  stated_ = reader_->frames_in_header();
}

// After it the reader reads the frame `index` next, or is at the end. Frames are skipped by their time if the
// video has a constant frame rate; with a variable one this may go too far, and they are skipped one by one.
void IndexedFrames::go_to(std::int64_t index) {
  const auto open = [&] {
    reader_ = std::make_unique<VideoReader>(video_, asked_fps_, 1);
    next_ = 0;
  };
  if (!reader_ || next_ > index) open();
  if (fps_ > 0 && index > next_) next_ += reader_->skip_to((double(index) - 0.5) / fps_);
  if (next_ > index) open();
  for (double t_s = 0; next_ < index && reader_->next(t_s);) ++next_;
}

std::optional<IndexedFrame> IndexedFrames::read(std::int64_t index) {
  const auto known =
      std::find_if(recent_.begin(), recent_.end(), [&](const IndexedFrame& f) { return f.index == index; });
  if (known != recent_.end()) return *known;
  if (index < 0) return {};
  go_to(index);
  IndexedFrame f;
  f.index = index;
  if (next_ != index || !reader_->next(f.t_s)) {
    reader_.reset();
    return {};
  }
  ++next_;
  auto picture = std::make_shared<GrayF>();
  reader_->picture(*picture);
  const std::size_t bytes = std::max<std::size_t>(1, picture->px.size() * sizeof(float));
  f.picture = std::move(picture);
  while (!recent_.empty() && (recent_.size() + 1) * bytes > kMostRecentBytes) recent_.pop_front();
  recent_.push_back(f);
  return f;
}

std::optional<IndexedFrame> IndexedFrames::find(std::int64_t index) {
  const std::lock_guard lock(mutex_);
  return read(index);
}

IndexedFrame IndexedFrames::frame(std::int64_t index) {
  if (auto f = find(index)) return *std::move(f);
  throw Error(Errc::input, video_.filename().string(),
              fmt::format("has no frame {}; the first frame is 0", index));
}

}  // namespace faba
