#include "vision/files/frame_encoder.h"

#include <algorithm>
#include <cmath>
#include <cstring>
#include <string>

#include "core/error.h"
#include "vision/files/ffmpeg.h"
#include "vision/files/kernels/yuv420.h"
#include "vision/files/libav.h"

namespace faba {
namespace {

using Frame = std::unique_ptr<AVFrame, libav::Free>;
using Packet = std::unique_ptr<AVPacket, libav::Free>;
constexpr double kLargePicture = 4e6;  // px
// Each picture is coded in as many slices, each by a thread of its own (x264 with "zerolatency"). The number
// is fixed, so that the bytes do not depend on the machine. Two slices add 1 % to the file size.
constexpr int kSlices = 2;

using Codec = std::unique_ptr<AVCodecContext, libav::Free>;

bool is_h264(FrameEncoder::Kind kind) {
  return kind == FrameEncoder::Kind::h264 || kind == FrameEncoder::Kind::h264_grey;
}

int even(int length) { return length + length % 2; }

void describe_h264(AVCodecContext& codec, FrameRate rate) {
  codec.width = even(codec.width);
  codec.height = even(codec.height);
  codec.pix_fmt = AV_PIX_FMT_YUV420P;
  codec.gop_size = std::max(1, rate.numerator / rate.denominator);
  codec.max_b_frames = 0;
  // Browsers shift grey values if the range is untagged or limited, and guess an untagged matrix from the
  // picture size.
  codec.color_range = AVCOL_RANGE_JPEG;
  codec.colorspace = AVCOL_SPC_SMPTE170M;
  codec.color_primaries = AVCOL_PRI_BT709;
  codec.color_trc = AVCOL_TRC_IEC61966_2_1;
  codec.chroma_sample_location = AVCHROMA_LOC_CENTER;
  FABA_AV(av_opt_set)(codec.priv_data, "preset", "veryfast", 0);
  FABA_AV(av_opt_set)(codec.priv_data, "tune", "zerolatency", 0);
  FABA_AV(av_opt_set)(codec.priv_data, "crf", "20", 0);
  // For small cells on camera noise, macroblock partitions and weighted prediction increase the encoding time
  // by a third and even the file size. Swarms have no scene cuts: their detection only adds key frames.
  std::string params = "cpu-independent=1:partitions=none:weightp=0:scenecut=0";
  // In large pictures arithmetic coding takes half of the time for an eighth of the file size; transforms of
  // 8 x 8 px and deblocking take a sixth of the rest for no smaller file and no better picture.
  if (double(codec.width) * codec.height > kLargePicture) params += ":no-cabac=1:8x8dct=0:no-deblock=1";
  FABA_AV(av_opt_set)(codec.priv_data, "x264-params", params.c_str(), 0);
}

}  // namespace

struct FrameEncoder::Impl {
  Kind kind;
  int width, height;
  FrameRate rate;
  std::string where;
  Codec codec{};
  Frame frame{};
  Packet packet{FABA_AV(av_packet_alloc)()};
  std::int64_t count = 0;
  bool restarted = false;  // the next picture needs a new encoder

  [[noreturn]] void fail(const std::string& what) const { throw Error(Errc::internal, where, what); }
  void open();
  template <class Pixel>
  void prepare(const Image<Pixel>& picture, bool kind_fits);
  std::span<const std::uint8_t> code();
  template <class Pixel>
  void copy(const Image<Pixel>& picture);
  void pad_to_yuv420();
};

void FrameEncoder::Impl::open() {
  libav::quiet();
  const char* name = is_h264(kind)        ? "libx264"
                     : kind == Kind::pgm  ? "pgm"
                     : kind == Kind::ppm  ? "ppm"
                     : kind == Kind::tiff ? "tiff"
                                          : "png";
  const AVCodec* encoder = FABA_AV(avcodec_find_encoder_by_name)(name);
  if (encoder == nullptr) {
    fail(std::string("this FFmpeg does not have the encoder ") + name +
         (is_h264(kind) ? "; install an FFmpeg with libx264, or record lossless_avi" : ""));
  }
  codec.reset(FABA_AV(avcodec_alloc_context3)(encoder));
  codec->width = width;
  codec->height = height;
  codec->time_base = {rate.denominator, rate.numerator};
  codec->framerate = {rate.numerator, rate.denominator};
  codec->thread_count = is_h264(kind) ? kSlices : 1;
  if (is_h264(kind)) {
    describe_h264(*codec, rate);
  } else {
    codec->pix_fmt = kind == Kind::png_grey16                        ? AV_PIX_FMT_GRAY16BE
                     : kind == Kind::png_colour || kind == Kind::ppm ? AV_PIX_FMT_RGB24
                                                                     : AV_PIX_FMT_GRAY8;
    codec->compression_level = 1;
    // Camera noise compresses best and fastest without prediction. Encoders without this option ignore it.
    FABA_AV(av_opt_set)(codec->priv_data, "pred", "none", 0);
  }
  libav::forget_messages();
  const int result = FABA_AV(avcodec_open2)(codec.get(), encoder, nullptr);
  if (result < 0) fail(std::string("the ") + name + " encoder cannot start: " + libav::reason(result));
  frame.reset(FABA_AV(av_frame_alloc)());
  frame->format = codec->pix_fmt;
  frame->width = codec->width;
  frame->height = codec->height;
  frame->color_range = codec->color_range;
  if (FABA_AV(av_frame_get_buffer)(frame.get(), 0) < 0) fail("out of memory for a video frame");
  count = 0;
  restarted = false;
}

template <class Pixel>
void FrameEncoder::Impl::copy(const Image<Pixel>& picture) {
  const std::size_t row_bytes = sizeof(Pixel) * static_cast<std::size_t>(width);
  for (int row = 0; row < height; ++row) {
    std::memcpy(frame->data[0] + std::ptrdiff_t{row} * frame->linesize[0],
                picture.px.data() + std::ptrdiff_t{row} * width, row_bytes);
  }
}

// Pads a grey picture in `frame` to even size and sets neutral chroma (4:2:0).
void FrameEncoder::Impl::pad_to_yuv420() {
  const std::ptrdiff_t stride = frame->linesize[0];
  if (width % 2 != 0)
    for (int row = 0; row < height; ++row) {
      std::uint8_t* last = frame->data[0] + row * stride + width - 1;
      last[1] = last[0];
    }
  if (height % 2 != 0)
    std::memcpy(frame->data[0] + height * stride, frame->data[0] + (height - 1) * stride,
                static_cast<std::size_t>(codec->width));
  for (int plane = 1; plane <= 2; ++plane)
    for (int row = 0; row < codec->height / 2; ++row)
      std::memset(frame->data[plane] + std::ptrdiff_t{row} * frame->linesize[plane], 128,
                  static_cast<std::size_t>(codec->width / 2));
}

std::span<const std::uint8_t> FrameEncoder::Impl::code() {
  libav::forget_messages();
  FABA_AV(av_packet_unref)(packet.get());
  frame->pts = count++;
  int result = FABA_AV(avcodec_send_frame)(codec.get(), frame.get());
  if (result >= 0) result = FABA_AV(avcodec_receive_packet)(codec.get(), packet.get());
  if (result < 0) fail("a frame cannot be encoded: " + libav::reason(result));
  return {packet->data, static_cast<std::size_t>(packet->size)};
}

template <class Pixel>
void FrameEncoder::Impl::prepare(const Image<Pixel>& picture, bool kind_fits) {
  const auto pixels = static_cast<std::size_t>(width) * static_cast<std::size_t>(height);
  if (!kind_fits || picture.width != width || picture.height != height || picture.px.size() != pixels) {
    fail("a frame of " + std::to_string(picture.width) + " x " + std::to_string(picture.height) +
         " px does not match the encoder: wrong pixel type or size; it must be " + std::to_string(width) +
         " x " + std::to_string(height) + " px");
  }
  if (restarted) open();
  if (FABA_AV(av_frame_make_writable)(frame.get()) < 0) fail("out of memory for a video frame");
}

FrameEncoder::FrameEncoder(Kind kind, int width, int height, FrameRate rate, std::string where)
    : impl_(std::make_unique<Impl>(Impl{kind, width, height, rate, std::move(where)})) {
  if (width < 1 || height < 1 || width > kMaxVideoSide || height > kMaxVideoSide) {
    impl_->fail("picture size " + std::to_string(width) + " x " + std::to_string(height) +
                " px is out of range; width and height must be between 1 and " +
                std::to_string(kMaxVideoSide) + " px");
  }
  impl_->open();
}
FrameEncoder::~FrameEncoder() = default;
FrameEncoder::FrameEncoder(FrameEncoder&&) noexcept = default;
FrameEncoder& FrameEncoder::operator=(FrameEncoder&&) noexcept = default;

std::span<const std::uint8_t> FrameEncoder::encode(const RgbImage& picture) {
  Impl& self = *impl_;
  self.prepare(picture, self.kind == Kind::png_colour || self.kind == Kind::ppm || self.kind == Kind::h264);
  if (self.kind == Kind::h264) {
    const AVFrame& to = *self.frame;
    to_yuv420(picture, {to.data[0], to.data[1], to.data[2], to.linesize[0], to.linesize[1], to.linesize[2]});
  } else {
    static_assert(sizeof(Rgb) == 3);
    self.copy(picture);
  }
  return self.code();
}

std::span<const std::uint8_t> FrameEncoder::encode(const Gray8& picture) {
  Impl& self = *impl_;
  self.prepare(picture, self.kind == Kind::png_grey || self.kind == Kind::pgm || self.kind == Kind::tiff ||
                            self.kind == Kind::h264_grey);
  self.copy(picture);
  if (self.kind == Kind::h264_grey) self.pad_to_yuv420();
  return self.code();
}

std::span<const std::uint8_t> FrameEncoder::encode(const Image<std::uint16_t>& picture) {
  Impl& self = *impl_;
  self.prepare(picture, self.kind == Kind::png_grey16);
  for (int row = 0; row < picture.height; ++row) {
    std::uint8_t* to = self.frame->data[0] + std::ptrdiff_t{row} * self.frame->linesize[0];
    const std::uint16_t* from = picture.px.data() + std::ptrdiff_t{row} * picture.width;
    for (int col = 0; col < picture.width; ++col) {  // PNG is big-endian
      *to++ = static_cast<std::uint8_t>(from[col] >> 8);
      *to++ = static_cast<std::uint8_t>(from[col] & 0xFF);
    }
  }
  return self.code();
}

// A new encoder takes much memory, and there may be no other picture.
void FrameEncoder::restart() { impl_->restarted = true; }

const AVCodecContext& FrameEncoder::codec() const { return *impl_->codec; }

}  // namespace faba
