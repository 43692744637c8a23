#pragma once
#include <cstddef>
#include <cstdint>
#include <vector>

namespace faba {

/// A grey picture. Pixel (col, row) has its centre at image position (col, row): x right, y down, unit px.
/// T is uint8_t for display and output, float (any grey scale) for measurements.
template <class T>
struct Image {
  int width = 0, height = 0;
  std::vector<T> px;  ///< row-major, width * height

  Image() = default;
  Image(int w, int h, T fill = T{}) : width(w), height(h), px(std::size_t(w) * std::size_t(h), fill) {}
  bool empty() const { return px.empty(); }
  T& at(int col, int row) { return px[std::size_t(row) * std::size_t(width) + std::size_t(col)]; }
  T at(int col, int row) const { return px[std::size_t(row) * std::size_t(width) + std::size_t(col)]; }
};
using Gray8 = Image<std::uint8_t>;
using GrayF = Image<float>;

struct Rgb {
  std::uint8_t r = 0, g = 0, b = 0;
  friend bool operator==(const Rgb&, const Rgb&) = default;
};
/// A colour picture, for renderings only.
using RgbImage = Image<Rgb>;

}  // namespace faba
