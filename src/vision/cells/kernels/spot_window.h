#pragma once
#include <array>
#include <cstddef>
#include <vector>

#include "core/vec.h"
#include "vision/image/image.h"

/// Pixel loops of the sub-pixel fit (internal; include vision/cells/detector.h instead).
namespace faba {

/// A spot: Gaussian with amplitude and covariance, image frame, px.
struct GaussianSpot {
  double x = 0, y = 0, offset = 0, amplitude = 0;
  Mat2 cov;
  bool valid = false;
};

/// Moments under a Gaussian window: sum, centroid relative to the centre of the window, covariance.
struct SpotMoments {
  double mass = 0, x = 0, y = 0;
  Mat2 cov;
};

/// Pixels around a position, from which other spots are subtracted. One object is used for many positions,
/// because its memory is kept. Not thread-safe.
class SpotWindow {
 public:
  /// `sd`: standard deviation of the Gaussian window, px.
  explicit SpotWindow(double sd);
  /// Copies the pixels around (col, row): those that offset() at this position and moments() within
  /// max_shift() of it need, and that the picture has.
  void place(const GrayF& picture, int col, int row);
  /// px, how far the fit may move from the position.
  double max_shift() const;
  /// Subtracts the light of another spot. A spot that is too far away to matter is ignored.
  void subtract(const GaussianSpot& other);
  /// Local offset: median of a ring around (x, y), 0 if the ring is outside of the picture.
  double offset(double x, double y);
  SpotMoments moments(double x, double y, double offset);

 private:
  std::size_t width() const { return std::size_t(right_) - std::size_t(left_) + 1; }
  double* row(int r) { return &px_[std::size_t(r - top_) * width()]; }

  double sd_;
  int col_ = 0, row_ = 0, left_ = 0, top_ = 0, right_ = -1, bottom_ = -1;
  std::vector<double> px_, ring_, across_, sums_;
  std::vector<std::array<double, 3>> weights_;
};

}  // namespace faba
