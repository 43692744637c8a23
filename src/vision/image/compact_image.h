#pragma once
#include <cstddef>
#include <cstdint>
#include <variant>
#include <vector>

#include "vision/image/image.h"
#include "vision/image/kernels/grey_map.h"

namespace faba {

/// A picture that is kept for later, exactly, in as few bytes as its values need: those of grey or
/// YUV video of 8 bits one byte per pixel; grey levels of up to 16 bits, and averages of integer ones over 4
/// or 16 px, two; all others four.
class CompactImage {
 public:
  explicit CompactImage(const GrayF& image) { assign(image); }
  /// Replaces the picture; the memory is used again.
  void assign(const GrayF& image);

  int width() const { return width_; }
  int height() const { return height_; }
  std::size_t bytes() const;
  GrayF image() const;
  /// The values of the pixels [begin, begin + n).
  void copy(std::size_t begin, std::size_t n, float* to) const;

 private:
  template <class T>
  bool pack(const GrayF& image, const GreyMap& map);

  int width_ = 0, height_ = 0;
  std::variant<std::vector<float>, std::vector<std::uint8_t>, std::vector<std::uint16_t>> values_;
  GreyMap map_;  ///< of the integers
};

}  // namespace faba
