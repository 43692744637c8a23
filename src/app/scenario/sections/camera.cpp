#include "app/scenario/sections/camera.h"

namespace faba {

Schema<CameraParams> CameraParams::schema() {
  return Schema<CameraParams>("camera", "Frame rate, delay and output of the camera")
      .add("rate", &CameraParams::rate,
           {.unit = "Hz",
            .min = 0.01,
            .max = 1e5,
            .doc = "Frames per second",
            .source = "thesis: 90 frames in 6 s (A0)"})
      .add("delay_frames", &CameraParams::delay_frames,
           {.min = 0, .max = 1000, .doc = "Delay from a frame to the control decision, in frames"})
      .add("jitter", &CameraParams::jitter,
           {.unit = "s",
            .min = 0,
            .max = 1e3,
            .doc = "Standard deviation of the frame times about regular times; deviations are limited to "
                   "0.4 frame periods"})
      .add("sensor", &CameraParams::sensor,
           {.doc = "positions: the control loop gets the positions of all cells; frames: it gets pictures "
                   "rendered "
                   "by the [microscope], in which the estimator detects the swarm",
            .choices = {"positions", "frames"}});
}

}  // namespace faba
