#pragma once
#include <optional>
#include <string>

#include "rig/camera.h"

namespace faba {

/// Parameters of OpenCV's VideoCapture.
struct CaptureParams {
  enum class Interface { any, v4l2, firewire, gstreamer, ffmpeg };
  std::string device = "0";
  Interface interface = Interface::any;
  int width = 0, height = 0;
  double rate = 0;
  std::optional<double> exposure, gain, white_balance;
};

/// Type of the function faba_open_capture in the module faba-capture.so, which comes from the same build as
/// the program. The caller owns the returned camera. Throws Error(device).
using OpenCapture = Camera*(const CaptureParams& p);

}  // namespace faba
