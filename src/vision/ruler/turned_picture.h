#pragma once
#include <vector>

#include "core/vec.h"
#include "vision/image/image.h"

namespace faba {

/// A picture turned about its centre, so that a direction of it lies along the rows. Turned frame: s to the
/// right along `angle` of the picture, t across it, both in px of the picture and zero at its centre.
class TurnedPicture {
 public:
  /// `angle` in rad, from the picture's x axis towards its y axis (clockwise as seen). Cubic interpolation
  /// (Catmull-Rom); what lies outside the picture is NaN.
  TurnedPicture(const GrayF& picture, double angle);

  /// Grey along s, the mean over `height` rows about t; NaN where one of them lies outside the picture.
  /// Element i belongs to s = first_s() + i. Empty when the strip leaves the turned picture.
  std::vector<double> profile(double t, int height) const;

  double first_s() const { return -(px_.width - 1) / 2.0; }
  double last_s() const { return (px_.width - 1) / 2.0; }
  double first_t() const { return -(px_.height - 1) / 2.0; }
  double last_t() const { return (px_.height - 1) / 2.0; }
  /// Position in the picture of a place of the turned frame.
  Vec2 image(double s, double t) const;
  /// The reverse: (s, t) of a position in the picture.
  Vec2 turned(Vec2 image) const;

 private:
  double cos_, sin_;
  Vec2 centre_image_;
  GrayF px_;
};

}  // namespace faba
