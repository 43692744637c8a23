#pragma once

namespace faba {

/// One detected spot: a bacterium or a bead. Image frame: x right, y down, px, pixel centres at integers.
struct Spot {
  double x_px = 0, y_px = 0;
  double sd_px =
      0;            ///< standard error of x and of y from the noise of the picture; excludes blur and overlap
  double mass = 0;  ///< integrated difference from the background, grey px^2, > 0 for both polarities
  double size_px = 0;     ///< full width at half maximum of a round Gaussian of the same area
  double elongation = 1;  ///< long over short standard deviation, >= 1
  double angle_rad =
      0;  ///< direction of the long axis in the picture, (-pi/2, pi/2]; undefined if elongation is near 1
  double snr = 0;       ///< signal-to-noise ratio: matched-filter response over its noise sd
  bool bright = false;  ///< brighter than the background
};

}  // namespace faba
