#pragma once
#include <string>
#include <vector>

#include "vision/drop/circle_fit.h"
#include "vision/image/image.h"

namespace faba {

struct DropEdgeOptions;

/// A picture made ready for the search of edges, or a halved copy of it. Grey runs from 0 to 255.
struct DropLevel {
  GrayF grey;        ///< hot pixels replaced, stretched between two percentiles
  GrayF flat;        ///< grey minus its mean over a square about each pixel: without broad shading
  double scale = 1;  ///< px of the picture per px of this copy

  /// From px of this copy to px of the picture: pixel centres of a copy lie between those of the picture.
  Vec2 to_picture(Vec2 p) const { return {p.x * scale + (scale - 1) / 2, p.y * scale + (scale - 1) / 2}; }
  Circle to_picture(const Circle& c) const { return {to_picture(c.centre), c.radius * scale}; }
  Circle to_level(const Circle& c) const {
    const double shift = (scale - 1) / 2;
    return {{(c.centre.x - shift) / scale, (c.centre.y - shift) / scale}, c.radius / scale};
  }
};

/// The prepared picture with its halved copies.
struct DropPicture {
  std::vector<DropLevel> levels;  ///< the picture itself first, each next one half the size
  double gain = 1;                ///< prepared grey per grey of the picture
  double contours =
      0;  ///< height of the contour lines that a scale of few greys leaves in even light, prepared grey
};

/// Replaces hot pixels, stretches to 0..255, makes the halved copies (smaller side at least 48 px) and takes
/// the broad shading off. Throws Error(Errc::input, options.name) for a picture under 64 px, not finite or
/// uniform.
DropPicture prepare_drop_picture(const GrayF& picture, const DropEdgeOptions& options);

}  // namespace faba
