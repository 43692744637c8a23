#pragma once
#include <cstdint>
#include <vector>

#include "vision/image/image.h"

namespace faba {

/// Anti-aliased discs of one radius, drawn once for each position within a pixel and then copied: ten times
/// as fast as cv::circle. The positions have the steps of OpenCV's drawing functions, 1/16 px.
class DiscSprites {
 public:
  explicit DiscSprites(double radius_px);
  /// Draws a disc at a position in px, y down. Parts beyond the border are not drawn.
  void draw(RgbImage& picture, double x, double y, Rgb colour) const;

 private:
  int side_;                            ///< px of a sprite, odd
  std::vector<std::uint8_t> coverage_;  ///< 0 to 255; sprite by sprite, each row by row
};

}  // namespace faba
