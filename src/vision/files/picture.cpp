#include "vision/files/picture.h"

#include <algorithm>
#include <cmath>
#include <iterator>
#include <span>
#include <string_view>
#include <vector>

#include "core/error.h"
#include "core/file.h"
#include "core/statistics.h"
#include "vision/files/av_stream.h"
#include "vision/files/frame_encoder.h"
#include "vision/files/input_file.h"
#include "vision/files/tiff/tiff_stack.h"

namespace faba {
namespace {

std::string_view as_text(std::span<const std::uint8_t> bytes) {
  return {reinterpret_cast<const char*>(bytes.data()), bytes.size()};
}

}  // namespace

Picture read_picture(const std::filesystem::path& path) {
  Picture picture;
  if (check_input_file(path) == InputKind::tiff) {
    TiffStack stack(path);
    stack.read(picture.grey);
    picture.bits = stack.bits();
    picture.pages = stack.pages();
  } else {
    AvStream stream(path);
    double t_s = 0;
    stream.read(picture.grey, t_s);
    picture.bits = stream.bits();
  }
  return picture;
}

Gray8 stretched(const GrayF& picture, double low_fraction, double high_fraction) {
  if (!(low_fraction >= 0 && low_fraction < high_fraction && high_fraction <= 1)) {
    throw Error(Errc::internal, "",
                "stretched: the fractions must satisfy 0 <= low_fraction < high_fraction <= 1");
  }
  Gray8 out(picture.width, picture.height);
  std::vector<float> finite;
  finite.reserve(picture.px.size());
  std::copy_if(picture.px.begin(), picture.px.end(), std::back_inserter(finite),
               [](float v) { return std::isfinite(v); });
  if (finite.empty()) return out;
  float low = quantile_low(finite, low_fraction);
  float high = quantile_low(finite, high_fraction);
  if (low == high) {
    const auto [least, most] = std::minmax_element(finite.begin(), finite.end());
    low = *least;
    high = *most;
  }
  const double gain = low == high ? 0 : 255 / (double(high) - double(low));
  const double offset = low == high ? 128 : 0;
  std::transform(picture.px.begin(), picture.px.end(), out.px.begin(), [&](float v) {
    const double shown =
        std::isfinite(v) ? std::clamp((double(v) - double(low)) * gain + offset, 0.0, 255.0) : 0.0;
    return static_cast<std::uint8_t>(std::lround(shown));
  });
  return out;
}

RgbImage displayed(const GrayF& picture) {
  const Gray8 grey = stretched(picture, 0.001, 0.999);
  RgbImage out(grey.width, grey.height);
  std::transform(grey.px.begin(), grey.px.end(), out.px.begin(), [](std::uint8_t g) { return Rgb{g, g, g}; });
  return out;
}

RgbImage read_displayed(const std::filesystem::path& path) {
  RgbImage colours;
  if (check_input_file(path) == InputKind::tiff) {
    TiffStack(path).read_colours(colours);
  } else {
    double t_s = 0;
    AvStream(path).read_colours(colours, t_s);
  }
  constexpr int kGrey = 8;  // difference of the channels of a grey picture after lossy coding (assumed)
  const bool coloured = std::any_of(colours.px.begin(), colours.px.end(), [](const Rgb& v) {
    return std::max({v.r, v.g, v.b}) - std::min({v.r, v.g, v.b}) > kGrey;
  });
  return coloured ? colours : displayed(read_picture(path).grey);
}

void write_png(const std::filesystem::path& path, const RgbImage& picture) {
  FrameEncoder encoder(FrameEncoder::Kind::png_colour, picture.width, picture.height, {}, path.string());
  write_file(path, as_text(encoder.encode(picture)));
}

void write_png(const std::filesystem::path& path, const Gray8& picture) {
  FrameEncoder encoder(FrameEncoder::Kind::png_grey, picture.width, picture.height, {}, path.string());
  write_file(path, as_text(encoder.encode(picture)));
}

}  // namespace faba
