#include "vision/files/frame_grey.h"

#include <algorithm>
#include <array>
#include <cstring>
#include <memory>
#include <vector>

#include "vision/files/ffmpeg.h"
#include "vision/image/grey_of.h"
#include "vision/image/kernels/grey_map.h"

namespace faba {
namespace {

const AVPixFmtDescriptor* describe(int pixel_format) {
  return FABA_AV(av_pix_fmt_desc_get)(static_cast<AVPixelFormat>(pixel_format));
}

bool has(const AVPixFmtDescriptor& format, std::uint64_t flag) { return (format.flags & flag) != 0; }

bool is_full_range(const RawFrame& frame, const AVPixFmtDescriptor& format) {
  if (frame.range == AVCOL_RANGE_JPEG) return true;
  if (has(format, AV_PIX_FMT_FLAG_RGB)) return true;
  const bool old_full_range_name = std::strncmp(format.name, "yuvj", 4) == 0;
  const bool grey_only = format.nb_components < 3;
  return old_full_range_name || (grey_only && frame.range == AVCOL_RANGE_UNSPECIFIED);
}

GreyMap scale_of(const RawFrame& frame, const AVPixFmtDescriptor& format) {
  const int depth = format.comp[0].depth;
  const auto most = static_cast<float>((1U << depth) - 1U);
  GreyMap scale;
  scale.white = depth <= 8 ? 255.0F : 65535.0F;
  float stored_black = 0, stored_white = most;
  if (depth >= 8 && !is_full_range(frame, format)) {
    stored_black = static_cast<float>(16U << (depth - 8));
    stored_white = static_cast<float>(235U << (depth - 8));
  }
  scale.black = stored_black;
  scale.gain = scale.white / (stored_white - stored_black);
  return scale;
}

// One byte per pixel, converted by a lookup table.
void apply_lookup_table(const RawFrame& frame, const std::array<float, 256>& table, GrayF& out) {
  for (int row = 0; row < out.height; ++row) {
    const std::uint8_t* in = frame.planes[0] + std::ptrdiff_t{row} * frame.strides[0];
    float* grey = &out.at(0, row);
    for (int col = 0; col < out.width; ++col) grey[col] = table[in[col]];
  }
}

std::array<float, 256> palette_table(const RawFrame& frame) {
  std::array<float, 256> table{};
  for (std::size_t i = 0; i < table.size(); ++i) {
    std::uint32_t argb = 0;
    std::memcpy(&argb, frame.planes[1] + 4 * i, sizeof argb);
    const auto channel = [&](int shift) { return static_cast<float>((argb >> shift) & 0xFFU); };
    table[i] = grey_of(channel(16), channel(8), channel(0));
  }
  return table;
}

// 8-bit grey or luma.
void by_luma(const RawFrame& frame, const GreyMap& scale, GrayF& out) {
  for (int row = 0; row < out.height; ++row)
    map_greys(frame.planes[0] + std::ptrdiff_t{row} * frame.strides[0], std::size_t(out.width), scale,
              &out.at(0, row));
}

// Any memory layout: libav unpacks one row of one channel per call.
class ChannelRows {
 public:
  ChannelRows(const RawFrame& frame, const AVPixFmtDescriptor& format) : frame_(frame), format_(format) {
    std::copy_n(frame.planes, planes_.size(), planes_.begin());
  }
  void read(int channel, int row, std::vector<std::uint16_t>& values) {
    values.resize(static_cast<std::size_t>(frame_.width));
    FABA_AV(av_read_image_line2)
    (values.data(), planes_.data(), frame_.strides, &format_, 0, row, channel, frame_.width, 0,
     sizeof(std::uint16_t));
  }

 private:
  const RawFrame& frame_;
  const AVPixFmtDescriptor& format_;
  std::array<const std::uint8_t*, 4> planes_{};
};

void by_channels(const RawFrame& frame, const AVPixFmtDescriptor& format, const GreyMap& scale, GrayF& out) {
  ChannelRows rows(frame, format);
  std::vector<std::uint16_t> first, green, blue;
  const bool colour = has(format, AV_PIX_FMT_FLAG_RGB) && format.nb_components >= 3;
  const bool white_is_0 = frame.pixel_format == AV_PIX_FMT_MONOWHITE;
  for (int row = 0; row < out.height; ++row) {
    rows.read(0, row, first);
    if (colour) {
      rows.read(1, row, green);
      rows.read(2, row, blue);
    }
    float* grey = &out.at(0, row);
    for (std::size_t i = 0; i < first.size(); ++i) {
      const auto value = static_cast<float>(white_is_0 ? 1 - first[i] : first[i]);
      grey[i] =
          scale(colour ? grey_of(value, static_cast<float>(green[i]), static_cast<float>(blue[i])) : value);
    }
  }
}

}  // namespace

int grey_bits(int pixel_format) {
  const AVPixFmtDescriptor* format = describe(pixel_format);
  if (format == nullptr || format->nb_components == 0) return 0;
  if (has(*format, AV_PIX_FMT_FLAG_HWACCEL | AV_PIX_FMT_FLAG_BAYER | AV_PIX_FMT_FLAG_FLOAT)) return 0;
  if (std::strncmp(format->name, "xyz", 3) == 0) return 0;
  const int depth = format->comp[0].depth;
  return depth > 16 ? 0 : depth > 8 ? 16 : 8;
}

void to_grey(const RawFrame& frame, GrayF& out) {
  const AVPixFmtDescriptor& format = *describe(frame.pixel_format);
  out.width = frame.width;
  out.height = frame.height;
  out.px.resize(static_cast<std::size_t>(frame.width) * static_cast<std::size_t>(frame.height));
  const bool palette = has(format, AV_PIX_FMT_FLAG_PAL);
  const GreyMap scale = scale_of(frame, format);
  const AVComponentDescriptor& luma = format.comp[0];
  const bool bytes = luma.depth == 8 && luma.step == 1 && luma.offset == 0 && luma.plane == 0;
  if (palette) {
    apply_lookup_table(frame, palette_table(frame), out);
  } else if (bytes && !has(format, AV_PIX_FMT_FLAG_RGB)) {
    by_luma(frame, scale, out);
  } else {
    by_channels(frame, format, scale, out);
  }
}

bool to_colours(const RawFrame& frame, RgbImage& out) {
  const auto from = static_cast<AVPixelFormat>(frame.pixel_format);
  const AVPixFmtDescriptor* format = describe(frame.pixel_format);
  if (format == nullptr || FABA_AV(sws_isSupportedInput)(from) == 0) return false;
  const std::unique_ptr<SwsContext, libav::Free> convert{FABA_AV(sws_getContext)(
      frame.width, frame.height, from, frame.width, frame.height, AV_PIX_FMT_RGB24,
      SWS_BILINEAR | SWS_ACCURATE_RND | SWS_FULL_CHR_H_INT, nullptr, nullptr, nullptr)};
  if (!convert) return false;
  const int* matrix = FABA_AV(sws_getCoefficients)(frame.matrix);
  const int full = is_full_range(frame, *format) ? 1 : 0;
  FABA_AV(sws_setColorspaceDetails)(convert.get(), matrix, full, matrix, 1, 0, 1 << 16, 1 << 16);
  out.width = frame.width;
  out.height = frame.height;
  out.px.resize(static_cast<std::size_t>(frame.width) * static_cast<std::size_t>(frame.height));
  static_assert(sizeof(Rgb) == 3);
  auto* const to = reinterpret_cast<std::uint8_t*>(out.px.data());
  const int stride = 3 * frame.width;
  return FABA_AV(sws_scale)(convert.get(), frame.planes, frame.strides, 0, frame.height, &to, &stride) ==
         frame.height;
}

std::string pixel_format_name(int pixel_format) {
  const AVPixFmtDescriptor* format = describe(pixel_format);
  return format == nullptr ? "unknown" : format->name;
}

}  // namespace faba
