#include "vision/files/video_reader.h"

#include <algorithm>
#include <cmath>
#include <optional>
#include <utility>

#include "core/error.h"
#include "vision/files/av_stream.h"
#include "vision/files/input_file.h"
#include "vision/files/picture_metadata.h"
#include "vision/files/picture_sequence.h"
#include "vision/files/tiff/tiff_stack.h"

namespace faba {

// Exactly one of the three readers is set.
struct VideoReader::Impl {
  std::optional<TiffStack> stack;
  std::optional<AvStream> stream;
  std::optional<PictureSequence> sequence;

  double fps = 0;  // override; 0: frame rate of the file

  std::filesystem::path path;
  int width = 0, height = 0;
  std::int64_t pages_read = 0;
  GrayF first_page;  // read by the constructor, which refuses an unreadable stack
  GrayF current;     // frame of next(), of stacks and sequences
  bool stack_truncated = false, stack_stopped = false;
  std::string stack_damage;

  bool read_page(GrayF& frame, double& t_s);
  bool seek_page(double t_s);
  void stop(const Error& error);
  double rescaled(double t_s) const;  // time of a stack or stream at the overridden rate
  double rescale() const;
};

// A stack is read up to its first damaged page.
void VideoReader::Impl::stop(const Error& error) {
  stack_truncated = stack_stopped = true;
  stack_damage = std::string(error.what()).substr(error.where().size() + 2);
}

bool VideoReader::Impl::read_page(GrayF& frame, double& t_s) {
  if (stack_stopped) return false;
  try {
    if (!first_page.empty()) {
      std::swap(frame, first_page);
      first_page = {};
    } else if (!stack->read(frame)) {
      return false;
    }
  } catch (const Error& error) {
    stop(error);
    return false;
  }
  if (frame.width != width || frame.height != height) {
    throw Error(
        Errc::input, path.string(),
        "page " + std::to_string(pages_read + 1) + " differs in size from the first; split the stack there");
  }
  t_s = static_cast<double>(pages_read) / (stack->fps() > 0 ? stack->fps() : 1);
  ++pages_read;
  return true;
}

VideoReader::VideoReader(const std::filesystem::path& path, double fps, unsigned threads)
    : impl_(std::make_unique<Impl>()) {
  impl_->path = path;
  impl_->fps = fps;
  if (is_picture_sequence(path)) {
    impl_->sequence.emplace(path, fps > 0 ? fps : picture_metadata(path).fps);
    impl_->width = impl_->sequence->width();
    impl_->height = impl_->sequence->height();
  } else if (check_input_file(path) == InputKind::tiff) {
    impl_->stack.emplace(path);
    impl_->stack->read(impl_->first_page);
    impl_->width = impl_->stack->width();
    impl_->height = impl_->stack->height();
  } else {
    impl_->stream.emplace(path, threads);
    impl_->width = impl_->stream->width();
    impl_->height = impl_->stream->height();
  }
}
VideoReader::~VideoReader() = default;
VideoReader::VideoReader(VideoReader&&) noexcept = default;
VideoReader& VideoReader::operator=(VideoReader&&) noexcept = default;

int VideoReader::width() const { return impl_->width; }
int VideoReader::height() const { return impl_->height; }
int VideoReader::bits() const {
  if (impl_->sequence) return impl_->sequence->bits();
  return impl_->stack ? impl_->stack->bits() : impl_->stream->bits();
}
double VideoReader::fps() const {
  if (impl_->sequence) return impl_->sequence->fps();
  if (impl_->fps > 0) return impl_->fps;
  return impl_->stack ? impl_->stack->fps() : impl_->stream->fps();
}
std::int64_t VideoReader::frames_in_header() const {
  if (impl_->sequence) return impl_->sequence->pictures();
  return impl_->stack ? impl_->stack->pages() : impl_->stream->frames_in_header();
}
bool VideoReader::truncated() const {
  if (impl_->sequence) return false;
  return impl_->stack ? impl_->stack_truncated : impl_->stream->truncated();
}
std::int64_t VideoReader::damaged_frames() const {
  if (impl_->sequence) return impl_->sequence->damaged_pictures();
  return impl_->stack ? std::int64_t{impl_->stack_truncated} : impl_->stream->damaged_frames();
}
const std::string& VideoReader::damage() const {
  if (impl_->sequence) return impl_->sequence->damage();
  return impl_->stack ? impl_->stack_damage : impl_->stream->damage();
}

double VideoReader::Impl::rescale() const {
  if (!(fps > 0)) return 1;
  const double stated = stack ? stack->fps() : stream->fps();
  return (stated > 0 ? stated : 1) / fps;
}

double VideoReader::Impl::rescaled(double t_s) const { return t_s * rescale(); }

std::int64_t VideoReader::skip_to(double t_s) {
  return impl_->stream ? impl_->stream->skip_to(t_s / impl_->rescale()) : 0;
}

bool VideoReader::Impl::seek_page(double t_s) {
  constexpr double kRounding = 1e-6;  // frame intervals, of times that are computed from them
  const double rate = stack->fps() > 0 ? stack->fps() : 1;
  first_page = {};
  stack_stopped = false;
  try {
    constexpr double kMostPages = 1e9;
    pages_read = stack->seek(std::int64_t(std::clamp(std::floor(t_s * rate + kRounding), 0.0, kMostPages)));
  } catch (const Error& error) {
    stop(error);
  }
  return true;
}

bool VideoReader::seek(double t_s) {
  t_s /= impl_->rescale();
  if (impl_->stack) return impl_->seek_page(t_s);
  if (impl_->stream) return impl_->stream->seek(t_s);
  impl_->sequence->seek(t_s * impl_->rescale());
  return true;
}

bool VideoReader::next(double& t_s) {
  if (!impl_->stream) return read(impl_->current, t_s);
  if (!impl_->stream->next(t_s)) return false;
  t_s = impl_->rescaled(t_s);
  return true;
}

void VideoReader::picture(GrayF& frame) {
  if (impl_->stream)
    impl_->stream->picture(frame);
  else
    frame = impl_->current;
}

bool VideoReader::read(GrayF& frame, double& t_s) {
  if (impl_->sequence) return impl_->sequence->read(frame, t_s);
  if (!(impl_->stack ? impl_->read_page(frame, t_s) : impl_->stream->read(frame, t_s))) return false;
  t_s = impl_->rescaled(t_s);
  return true;
}

bool VideoReader::read_colours(RgbImage& frame, double& t_s) {
  if (impl_->stream) {
    if (!impl_->stream->read_colours(frame, t_s)) return false;
    t_s = impl_->rescaled(t_s);
    return true;
  }
  GrayF grey;
  if (!read(grey, t_s)) return false;
  const float to_8_bits = bits() > 8 ? 255.0F / 65535.0F : 1.0F;
  frame.width = grey.width;
  frame.height = grey.height;
  frame.px.resize(grey.px.size());
  std::transform(grey.px.begin(), grey.px.end(), frame.px.begin(), [&](float g) {
    const auto level = static_cast<std::uint8_t>(std::clamp(g * to_8_bits + 0.5F, 0.0F, 255.0F));
    return Rgb{level, level, level};
  });
  return true;
}

}  // namespace faba
