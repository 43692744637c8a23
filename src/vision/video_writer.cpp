#include "vision/video_writer.h"

#include <system_error>

#include "core/file.h"
#include "vision/frame_encoder.h"
#include "vision/remux.h"

namespace faba {

struct VideoWriter::Impl {
  VideoFormat format;
  FrameRate rate;
  FrameEncoder encoder;
  OutputFile file;
  bool fresh = true;  // the encoder holds no earlier frame

  void restart() {
    if (!fresh) encoder.restart();
    fresh = true;
  }
};

namespace {
FrameEncoder::Kind kind_of(VideoFormat format) {
  return format == VideoFormat::mp4 ? FrameEncoder::Kind::h264 : FrameEncoder::Kind::png_colour;
}
}  // namespace

VideoWriter::VideoWriter(const std::filesystem::path& part, VideoFormat format, int width, int height,
                         double fps, std::uint64_t resume_at_bytes) {
  const FrameRate rate = frame_rate_near(fps);
  // NOLINTNEXTLINE(modernize-make-unique): an aggregate
  impl_.reset(new Impl{format, rate, FrameEncoder(kind_of(format), width, height, rate, part.string()),
                       OutputFile(part, resume_at_bytes)});
}
VideoWriter::~VideoWriter() = default;
VideoWriter::VideoWriter(VideoWriter&&) noexcept = default;
VideoWriter& VideoWriter::operator=(VideoWriter&&) noexcept = default;

void VideoWriter::write(const RgbImage& frame) {
  Impl& self = *impl_;
  const auto coded = self.encoder.encode(frame);
  self.fresh = false;
  try {
    self.file.append(coded);
  } catch (...) {
    self.restart();  // what comes next must not be predicted from a frame that is not in the file
    throw;
  }
}

std::uint64_t VideoWriter::sync() {
  impl_->file.sync();
  impl_->restart();
  return impl_->file.size();
}

void VideoWriter::finish(const std::filesystem::path& final_path, bool keep_part) {
  impl_->file.sync();
  remux(impl_->file.path(), impl_->format, impl_->rate, final_path);
  impl_->file.close();
  if (keep_part) return;
  std::error_code ignored;
  std::filesystem::remove(impl_->file.path(), ignored);
}

}  // namespace faba
