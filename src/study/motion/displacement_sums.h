#pragma once
#include <array>
#include <vector>

#include "core/vec.h"
#include "study/motion/kernels/correlation_window.h"
#include "vision/image/image.h"

namespace faba {

/// Longest displacement between two pictures that is compared, px of a picture of ResponseFrames.
inline constexpr int kLongestShift = 32;

/// Values against the displacement along a direction, -kLongestShift to kLongestShift px.
using ShiftProfile = std::array<double, 2 * kLongestShift + 1>;
inline std::size_t profile_index(int displacement) {
  const int i = displacement + kLongestShift;
  return std::size_t(i);
}

/// A picture of objects, smoothed over the size of an object, and their pixels.
struct ObjectPicture {
  GrayF light;                      ///< less that of the surround; 0 below the noise
  std::vector<SparsePixel> pixels;  ///< of objects, with the value 1; of wide ones not all
};

/// `objects`: a picture of ResponseFrames; `size_px`: full width at half maximum of an object; `noise`:
/// standard deviation of a pixel.
ObjectPicture object_picture(const GrayF& objects, double size_px, double noise);

/// The displacements of a profile: those along a direction, a unit vector in the image frame, and up to
/// `half_width` px across it.
struct ShiftWindow {
  Vec2 along{1, 0};
  double half_width = 0;
};

/// Sums of a picture over the objects of another one against the displacement between their pixels, in two
/// dimensions.
class DisplacementSums {
 public:
  double at(int dx, int dy) const { return sums_[index(dx, dy)]; }
  void add(const DisplacementSums& o, double factor);
  /// Sums over the window against the displacement along it.
  ShiftProfile profile(const ShiftWindow& window) const;
  /// Mean displacement across the direction, of the difference between both ways along it, between the
  /// displacements `from` and `to` along; 0 if none prevails. px.
  double across(const ShiftWindow& window, double from, double to) const;

 private:
  friend class PictureCorrelator;
  static constexpr int kSide = 2 * kLongestShift + 1;
  static std::size_t index(int dx, int dy) { return profile_index(dy) * kSide + profile_index(dx); }
  std::vector<double> sums_ = std::vector<double>(std::size_t(kSide) * kSide);
};

/// Compares pictures for displacements about one direction.
class PictureCorrelator {
 public:
  /// Displacements in the window or at most kMostTurn off its direction are compared.
  explicit PictureCorrelator(const ShiftWindow& window);
  /// From the first picture to the second: the mean of the second one over the objects of the first and of
  /// the first one over the objects of the second. Several threads may call it at the same time.
  DisplacementSums between(const ObjectPicture& a, const ObjectPicture& b) const;

  static constexpr double kMostTurn = 0.35;  ///< rad. Assumed

 private:
  DisplacementSums mean_of_both(const CorrelationSums& forward, const CorrelationSums& backward) const;
  bool inside(int dx, int dy) const;
  ShiftWindow window_;
  CorrelationWindow compared_{kLongestShift};
};

}  // namespace faba
