#pragma once

namespace faba {

/// One spot found in a frame: a bacterium, a bead. Image frame: x right, y down, px, pixel centres at whole
/// numbers.
struct Spot {
  double x_px = 0, y_px = 0;
  double sd_px =
      0;            ///< standard error of x and of y from the picture's noise; blur and overlap are not in it
  double mass = 0;  ///< integrated difference from the background, grey px^2, > 0 whatever the polarity
  double size_px = 0;     ///< full width at half maximum of a round Gaussian of the same area
  double elongation = 1;  ///< long over short standard deviation, >= 1
  double angle_rad =
      0;           ///< of the long axis in the picture, (-pi/2, pi/2]; meaningless when elongation is near 1
  double snr = 0;  ///< matched-filter response over its noise sd
  bool bright = false;  ///< brighter than the background
};

}  // namespace faba
