#pragma once
#include <optional>
#include <vector>

#include "study/quality/quality.h"
#include "vision/flow/flow.h"

namespace faba {

/// Tests flows by the pictures that they were computed from: the second picture is moved back along the flow,
/// and its difference from the first one is compared with the noise of the pictures.
///
/// With noise of variance s^2, a true displacement d and an error e of the flow, the mean square difference
/// is 2 s^2 + g^2 d^2 before and 2 s^2 + g^2 e^2 after, g being the gradient of the pictures. So (after - 2
/// s^2) / (before - 2 s^2) estimates the square of the relative error, and 2 s^2 / before is the part of the
/// difference that no flow can explain.
class FlowCheck {
 public:
  /// `side`: px of the video per pixel of the pictures.
  void add(const GrayF& a, const GrayF& b, const Flow& flow, double side = 1);

  /// after / before; empty without pictures and for equal ones.
  std::optional<double> unexplained() const;
  /// `mean_speed_px`: in px of the video.
  std::vector<Warning> warnings(double mean_speed_px) const;

 private:
  double noise_part() const { return before_ > 0 ? noise_ / before_ : 0; }
  void warn_residual(std::vector<Warning>& out) const;
  void warn_noise(std::vector<Warning>& out) const;
  void warn_light(double mean_speed_px, std::vector<Warning>& out) const;
  void warn_stripes(std::vector<Warning>& out) const;

  double before_ = 0, after_ = 0;  ///< sums of the squared differences
  double noise_ = 0;               ///< sum of 2 s^2
  double xx_ = 0, xy_ = 0, yy_ = 0,
         changed_ = 0;  ///< products of the gradients, and number of the changed pixels
  double light_px_ =
      0;  ///< sum of the displacements that a change of the mean grey imitates, px of the video
  int pairs_ = 0;
};

}  // namespace faba
