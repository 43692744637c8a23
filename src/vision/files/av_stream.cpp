#include "vision/files/av_stream.h"

#include <algorithm>
#include <cmath>

#include "vision/files/av_decoder.h"

namespace faba {
namespace {

constexpr unsigned kMostDecoders = 8;  // each has a frame in memory

}  // namespace

AvStream::AvStream(const std::filesystem::path& path, unsigned threads)
    : decoder_(std::make_unique<AvDecoder>()) {
  decoder_->path = path;
  decoder_->threads = std::min(threads, kMostDecoders);
  try {
    decoder_->open();
  } catch (const Damaged&) {
    read_by_one_thread();
  }
}

// With several threads an error is reported when further packets have been sent to the decoder. What a
// damaged file gives must not depend on that, so it is read again up to the same frame.
void AvStream::read_by_one_thread() {
  auto again = std::make_unique<AvDecoder>();
  again->path = decoder_->path;
  again->open();
  if (decoder_->skipped_to) again->skip_to(*decoder_->skipped_to);
  RawFrame frame;
  for (double t_s = 0; again->delivered < decoder_->delivered && again->next(frame, t_s);) {
  }
  decoder_ = std::move(again);
}

AvStream::~AvStream() = default;
AvStream::AvStream(AvStream&&) noexcept = default;
AvStream& AvStream::operator=(AvStream&&) noexcept = default;

int AvStream::width() const { return decoder_->width; }
int AvStream::height() const { return decoder_->height; }
int AvStream::bits() const { return decoder_->pixel_bits; }
double AvStream::fps() const { return decoder_->fps; }
bool AvStream::truncated() const { return decoder_->truncated; }
std::int64_t AvStream::damaged_frames() const { return decoder_->damaged; }
const std::string& AvStream::damage() const { return decoder_->damage; }

std::int64_t AvStream::frames_in_header() const {
  if (decoder_->still) return 1;
  const AVStream& stream = *decoder_->stream;
  if (stream.nb_frames > 0) return stream.nb_frames;
  double duration_s = 0;
  if (stream.duration > 0) {
    duration_s = static_cast<double>(stream.duration) * av_q2d(stream.time_base);
  } else if (decoder_->container->duration > 0) {
    duration_s = static_cast<double>(decoder_->container->duration) / AV_TIME_BASE;
  }
  return std::llround(duration_s * decoder_->fps);
}

std::int64_t AvStream::skip_to(double t_s) { return decoder_->skip_to(*(decoder_->skipped_to = t_s)); }

bool AvStream::seek(double t_s) { return decoder_->threads == 1 && decoder_->seek(t_s); }

bool AvStream::next(double& t_s) {
  try {
    return decoder_->next(decoder_->current, t_s);
  } catch (const Damaged&) {
    read_by_one_thread();
  }
  return decoder_->next(decoder_->current, t_s);
}

void AvStream::picture(GrayF& frame) { to_grey(decoder_->current, frame); }

bool AvStream::read(GrayF& frame, double& t_s) {
  if (!next(t_s)) return false;
  picture(frame);
  return true;
}

bool AvStream::read_colours(RgbImage& frame, double& t_s) {
  if (!next(t_s)) return false;
  if (!to_colours(decoder_->current, frame)) decoder_->refuse("the pixel format cannot be converted to RGB");
  return true;
}

}  // namespace faba
