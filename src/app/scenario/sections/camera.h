#pragma once
#include "core/schema.h"

namespace faba {

/// The table [camera].
struct CameraParams {
  enum class Sensor { positions, frames };
  double rate = 15;
  int delay_frames = 0;
  double jitter = 0;
  Sensor sensor = Sensor::positions;
  static Schema<CameraParams> schema();
};

}  // namespace faba
