#pragma once
#include <optional>

#include "core/schema.h"

namespace faba {

/// Objective, camera and sample of a planned experiment, SI. The defaults are those of the thesis with its
/// objective 10x.
struct OpticsSetup {
  double magnification = 10;         ///< of the objective, as engraved on it
  double numerical_aperture = 0.25;  ///< of the objective
  /// Image scale; default: kThesisUmPerPx times 10 / magnification, or from the size of a camera pixel.
  std::optional<double> um_per_px = {};
  std::optional<double> pixel_size = {};  ///< m, of the camera sensor
  double tube_factor = 1;               ///< focal length of the tube lens over that of the objective's system
  int width_px = 640, height_px = 480;  ///< of the pictures
  double frame_rate = 15;               ///< Hz
  std::optional<double> exposure_time = {};  ///< s; default: the smaller of 10 ms and half the frame period
  double speed = 186e-6;                     ///< m/s, of the cells
  double cell_diameter = 1.4e-6;             ///< m
  std::optional<double> cell_length = {};    ///< m, end to end; default: cell_diameter (a coccus)
  double cells_per_mm2 = 1000;               ///< cells per area of the picture
  double drop_radius = 0.88e-3;              ///< m

  /// Schema of all keys with unit, range, description and source; presets: objectives.
  static Schema<OpticsSetup> schema();
};

/// Scale of the thesis with the objective 10x (table 4.1), um/px.
inline constexpr double kThesisUmPerPx = 0.8015;

}  // namespace faba
