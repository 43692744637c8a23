#include "app/scenario/sections/camera.h"

namespace faba {

Schema<CameraParams> CameraParams::schema() {
  return Schema<CameraParams>("camera", "When the camera looks, and what it tells")
      .add("rate", &CameraParams::rate,
           {.unit = "Hz",
            .min = 0.01,
            .max = 1e5,
            .doc = "Frames per second",
            .source = "thesis: 90 frames in 6 s (A0)"})
      .add("delay_frames", &CameraParams::delay_frames,
           {.min = 0, .max = 1000, .doc = "Age of a picture, in frames, when the controller gets it"})
      .add("jitter", &CameraParams::jitter,
           {.unit = "s",
            .min = 0,
            .max = 1e3,
            .doc = "Sd of the frames' times about the regular ones, at most 0.4 frames to either side"})
      .add("sensor", &CameraParams::sensor,
           {.doc = "positions: the loop is told where every cell is; frames: it gets pictures as the "
                   "[microscope] renders them, and has to find the cells itself",
            .choices = {"positions", "frames"}});
}

}  // namespace faba
