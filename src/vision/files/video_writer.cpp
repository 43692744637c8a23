#include "vision/files/video_writer.h"

#include <system_error>

#include "core/error.h"
#include "core/file.h"
#include "vision/files/frame_encoder.h"
#include "vision/files/remux.h"

namespace faba {

struct VideoWriter::Impl {
  VideoFormat format;
  FrameRate rate;
  FrameEncoder encoder;
  OutputFile file;
  bool fresh = true;  // the encoder has no previous frame

  void restart() {
    if (!fresh) encoder.restart();
    fresh = true;
  }
};

namespace {
FrameEncoder::Kind kind_of(VideoFormat format, VideoPixels pixels) {
  using Kind = FrameEncoder::Kind;
  const bool mp4 = format == VideoFormat::mp4;
  if (pixels == VideoPixels::colour) return mp4 ? Kind::h264 : Kind::png_colour;
  if (pixels == VideoPixels::grey8) return mp4 ? Kind::h264_grey : Kind::png_grey;
  if (mp4) throw Error(Errc::internal, "video", "mp4 does not support 16-bit grey; use lossless_avi");
  return Kind::png_grey16;
}
}  // namespace

VideoWriter::VideoWriter(const std::filesystem::path& part, VideoFormat format, int width, int height,
                         double fps, std::uint64_t resume_at_bytes, VideoPixels pixels) {
  const FrameRate rate = frame_rate_near(fps);
  // NOLINTNEXTLINE(modernize-make-unique): an aggregate
  impl_.reset(new Impl{format, rate,
                       FrameEncoder(kind_of(format, pixels), width, height, rate, part.string()),
                       OutputFile(part, resume_at_bytes)});
}
VideoWriter::~VideoWriter() = default;
VideoWriter::VideoWriter(VideoWriter&&) noexcept = default;
VideoWriter& VideoWriter::operator=(VideoWriter&&) noexcept = default;

template <class Pixel>
void VideoWriter::append(const Image<Pixel>& frame) {
  Impl& self = *impl_;
  const auto coded = self.encoder.encode(frame);
  self.fresh = false;
  try {
    self.file.append(coded);
  } catch (...) {
    self.restart();  // the next frame must not be predicted from a frame that is not in the file
    throw;
  }
}

void VideoWriter::write(const RgbImage& frame) { append(frame); }
void VideoWriter::write(const Gray8& frame) { append(frame); }
void VideoWriter::write(const Image<std::uint16_t>& frame) { append(frame); }

void VideoWriter::restart() { impl_->restart(); }

std::uint64_t VideoWriter::sync() {
  impl_->file.sync();
  restart();
  return impl_->file.size();
}

void VideoWriter::finish(const std::filesystem::path& final_path, bool keep_part,
                         const std::function<double(long long frame)>& time_s) {
  impl_->file.sync();
  remux(impl_->file.path(), impl_->format, impl_->rate, impl_->encoder, final_path, time_s);
  impl_->file.close();
  if (keep_part) return;
  std::error_code ignored;
  std::filesystem::remove(impl_->file.path(), ignored);
}

}  // namespace faba
