#pragma once
#include <optional>
#include <string>

#include "core/schema.h"

namespace faba {

/// The table [microscope]: optics, camera and light of a rendered video. Light is counted in shares of white,
/// the brightest grey that the camera gives, so that nothing here depends on the number of bits.
struct MicroscopeParams {
  double psf_sd = 0.46e-6;            ///< m, Gaussian sd of the point-spread function in focus
  double cell_diameter = 1.4e-6;      ///< m
  std::optional<double> cell_length;  ///< m, end to end; a coccus, as long as wide, when absent
  double contrast = -0.4;   ///< grey change at the middle of a cell much larger than the blur, relative
  double depth_spread = 0;  ///< m, sd of the cells' distances from the focal plane
  double depth_of_field = 6.4e-6;       ///< m, defocus at which the blur is sqrt(2) times that in focus
  double level = 0.58;                  ///< share of white in the middle of the empty picture
  double vignetting = 0.1;              ///< share of the light lost in the corners
  double unevenness = 0.01;             ///< rms of the slow relative variation of the background
  double edge_contrast = -0.45;         ///< relative grey at the middle of the line along the drop's edge
  double edge_width = 2e-6;             ///< m, Gaussian sd of that line and of the step across the edge
  double outside_level = 0.95;          ///< light outside the drop relative to inside
  std::optional<double> exposure_time;  ///< s; 10 ms or half a frame, the shorter, when absent
  double full_well = 8000;              ///< electrons at white
  double read_noise = 8;                ///< electrons, sd
  std::optional<double> noise;          ///< share of white, sd; in place of shot and read noise
  double drift = 0;                     ///< relative change of the lamp per second
  double flicker = 0;                   ///< relative sd of the lamp from frame to frame
  int bits = 8;                         ///< 8 or 16
  std::string background;  ///< a video whose temporal median and noise stand in for light and noise

  double length() const { return cell_length.value_or(cell_diameter); }  ///< m
  /// Every key with unit, range, sentence and source.
  static Schema<MicroscopeParams> schema();
  /// Finds the background's file as the scenario `n` names it.
  static void settle(MicroscopeParams& p, const Node& n);
};

}  // namespace faba
