#include "vision/image/compact_image.h"

#include <algorithm>

namespace faba {
namespace {

constexpr GreyMap kFull, kLimited{16, 255.0F / 219, 255};  // of 8 bits
constexpr GreyMap kAverages{0, 1.0F / 16, 65535.0F / 16};  // over up to 16 px
constexpr GreyMap kWords{0, 1, 65535};
// px: a picture that does not fit is noticed early.
constexpr std::size_t kPackedAtOnce = std::size_t(1) << 14;

}  // namespace

void CompactImage::assign(const GrayF& image) {
  width_ = image.width;
  height_ = image.height;
  for (const GreyMap& map : {kFull, kLimited})
    if (pack<std::uint8_t>(image, map)) return;
  for (const GreyMap& map : {kAverages, kWords})
    if (pack<std::uint16_t>(image, map)) return;
  values_ = image.px;
}

template <class T>
bool CompactImage::pack(const GrayF& image, const GreyMap& map) {
  const std::size_t pixels = image.px.size();
  if (!std::holds_alternative<std::vector<T>>(values_)) values_ = std::vector<T>();
  auto& values = std::get<std::vector<T>>(values_);
  values.clear();
  values.reserve(pixels);
  for (std::size_t begin = 0; begin < pixels; begin += kPackedAtOnce) {
    const std::size_t n = std::min(kPackedAtOnce, pixels - begin);
    values.resize(begin + n);
    if (!unmap_greys(&image.px[begin], n, map, &values[begin])) return false;
  }
  map_ = map;
  return true;
}

std::size_t CompactImage::bytes() const {
  return std::visit([](const auto& values) { return values.size() * sizeof(values[0]); }, values_);
}

GrayF CompactImage::image() const {
  GrayF out(width_, height_);
  copy(0, out.px.size(), out.px.data());
  return out;
}

void CompactImage::copy(std::size_t begin, std::size_t n, float* to) const {
  if (const auto* floats = std::get_if<std::vector<float>>(&values_))
    std::copy_n(floats->data() + begin, n, to);
  else if (const auto* bytes = std::get_if<std::vector<std::uint8_t>>(&values_))
    map_greys(bytes->data() + begin, n, map_, to);
  else
    map_greys(std::get<std::vector<std::uint16_t>>(values_).data() + begin, n, map_, to);
}

}  // namespace faba
