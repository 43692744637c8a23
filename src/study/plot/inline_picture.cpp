#include "study/plot/inline_picture.h"

#include <fmt/format.h>

#include <cstdint>
#include <span>

#include "study/plot/markup.h"
#include "vision/files/frame_encoder.h"

namespace faba {
namespace {

std::string base64(std::span<const std::uint8_t> bytes) {
  constexpr const char* kDigits = "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
  std::string out;
  for (std::size_t i = 0; i < bytes.size(); i += 3) {
    const auto byte = [&](std::size_t k) { return i + k < bytes.size() ? std::uint32_t(bytes[i + k]) : 0U; };
    const std::uint32_t word = byte(0) << 16 | byte(1) << 8 | byte(2);
    for (std::size_t k = 0; k < 4; ++k)
      out += i + k > bytes.size() ? '=' : kDigits[word >> (18 - 6 * k) & 63];
  }
  return out;
}

}  // namespace

std::string picture_url(const RgbImage& picture) {
  FrameEncoder encoder(FrameEncoder::Kind::png_colour, picture.width, picture.height, {}, "report");
  return "data:image/png;base64," + base64(encoder.encode(picture));
}

std::string inline_picture(const RgbImage& picture, std::string_view alternative) {
  return fmt::format("<img style=\"width:100%;height:auto\" alt=\"{}\" src=\"{}\" />\n",
                     escape_markup(alternative), picture_url(picture));
}

}  // namespace faba
