#pragma once
#include <string>
#include <vector>

#include "vision/drop/circle_fit.h"
#include "vision/image/image.h"

namespace faba {

struct DropEdgeOptions;

/// One pyramid level: the prepared picture or a downscaled copy. Grey values 0 to 255.
struct DropLevel {
  GrayF grey;        ///< hot pixels replaced, stretched between two percentiles
  GrayF flat;        ///< grey minus its local mean over a square: without shading
  double scale = 1;  ///< px of the picture per px of this level

  /// Converts px of this level to px of the picture: pixel centres of a level lie between those of the
  /// picture.
  Vec2 to_picture(Vec2 p) const { return {p.x * scale + (scale - 1) / 2, p.y * scale + (scale - 1) / 2}; }
  Circle to_picture(const Circle& c) const { return {to_picture(c.centre), c.radius * scale}; }
  Circle to_level(const Circle& c) const {
    const double shift = (scale - 1) / 2;
    return {{(c.centre.x - shift) / scale, (c.centre.y - shift) / scale}, c.radius / scale};
  }
};

/// The prepared picture with its pyramid.
struct DropPicture {
  std::vector<DropLevel> levels;  ///< full resolution first, each next level half the size
  double gain = 1;                ///< grey of the levels per grey of the picture
  double contours = 0;            ///< height of quantisation contours in smooth light, grey of the levels
};

/// Replaces hot pixels, stretches to 0..255, builds the pyramid (smaller side at least 48 px) and subtracts
/// the shading. Throws Error(Errc::input, options.name) when a side is below 64 px, or the picture is not
/// finite or uniform.
DropPicture prepare_drop_picture(const GrayF& picture, const DropEdgeOptions& options);

}  // namespace faba
