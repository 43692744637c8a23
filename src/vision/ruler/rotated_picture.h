#pragma once
#include <vector>

#include "core/vec.h"
#include "vision/image/image.h"

namespace faba {

/// A picture rotated about its centre, so that a given direction is along the rows. Rotated frame: s to the
/// right along `angle` of the picture, t across it, both in px of the picture and zero at its centre.
class RotatedPicture {
 public:
  /// `angle`: rad, from the x axis of the picture towards its y axis (clockwise as displayed). Cubic
  /// interpolation (Catmull-Rom); NaN outside the picture.
  RotatedPicture(const GrayF& picture, double angle);

  /// Grey profile along s, averaged over `height` rows around t; NaN where one of them is outside the
  /// picture. Element i belongs to s = first_s() + i. Empty when the strip leaves the rotated picture.
  std::vector<double> profile(double t, int height) const;

  double first_s() const { return -(px_.width - 1) / 2.0; }
  double last_s() const { return (px_.width - 1) / 2.0; }
  double first_t() const { return -(px_.height - 1) / 2.0; }
  double last_t() const { return (px_.height - 1) / 2.0; }
  /// Position in the picture of a point of the rotated frame.
  Vec2 image(double s, double t) const;
  /// The inverse: (s, t) of a position in the picture.
  Vec2 rotated(Vec2 image) const;

 private:
  double cos_, sin_;
  Vec2 centre_image_;
  GrayF px_;
};

}  // namespace faba
