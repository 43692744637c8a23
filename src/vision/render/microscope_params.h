#pragma once
#include <optional>
#include <string>

#include "core/schema.h"

namespace faba {

/// The table [microscope]: optics, camera and light of a rendered video. Light is a fraction of white, the
/// maximum grey value of the camera, so the parameters do not depend on the bit depth.
struct MicroscopeParams {
  enum class Mode { bright_field, phase_contrast, fluorescence };
  Mode mode = Mode::bright_field;
  double psf_sd = 0.46e-6;            ///< m, sd of the Gaussian point-spread function in focus
  double cell_diameter = 1.4e-6;      ///< m
  std::optional<double> cell_length;  ///< m, end to end; default: cell_diameter (a coccus)
  double contrast = -0.4;          ///< relative grey change at the centre of a cell much larger than the blur
  double depth_spread = 0;         ///< m, sd of the distances of the cells from the focal plane
  double depth_of_field = 6.4e-6;  ///< m, defocus at which the blur is sqrt(2) times the blur in focus
  double halo = 0.8;               ///< phase contrast: fraction of the density of a cell in its halo
  double halo_width = 3e-6;        ///< m, Gaussian sd of the halo, before the blur
  double emission = 0.3;  ///< fluorescence: light of a cell much larger than the blur, at time 0, of white
  double background_emission = 0.04;     ///< fluorescence: light without cells at the picture centre
  std::optional<double> bleaching_time;  ///< s, fluorescence: time constant; default: no bleaching
  double level = 0.58;                   ///< background at the picture centre, fraction of white
  double vignetting = 0.1;               ///< fraction of the light lost in the corners
  double unevenness = 0.01;              ///< rms of the slow relative variation of the background
  double edge_contrast = -0.45;  ///< relative grey change at the centre of the line along the drop edge
  double edge_width = 2e-6;      ///< m, Gaussian sd of that line and of the step across the edge
  double outside_level = 0.95;   ///< light outside the drop relative to inside
  std::optional<double> exposure_time;  ///< s; default: the smaller of 10 ms and half the frame period
  double full_well = 8000;              ///< electrons at white
  double read_noise = 8;                ///< electrons, sd
  std::optional<double> noise;          ///< sd, fraction of white; replaces shot noise and read noise
  double drift = 0;                     ///< relative change of the lamp intensity per second
  double flicker = 0;                   ///< relative sd of the lamp intensity from frame to frame
  int bits = 8;                         ///< 8 or 16
  std::string background;               ///< video; its temporal median and noise replace light and noise

  double length() const { return cell_length.value_or(cell_diameter); }  ///< m
  /// Schema of all keys with unit, range, description and source.
  static Schema<MicroscopeParams> schema();
  /// Resolves the path of the background video relative to the scene file of `n`.
  static void settle(MicroscopeParams& p, const Node& n);
};

}  // namespace faba
