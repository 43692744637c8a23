#include "control/foreground_params.h"

#include <fmt/format.h>

#include "core/error.h"

namespace faba {

ForegroundOptions ForegroundParams::options() const {
  ForegroundOptions o;
  o.cell_px = cell_px;
  o.polarity = cells == Cells::dark     ? Polarity::dark
               : cells == Cells::bright ? Polarity::bright
                                        : Polarity::automatic;
  o.threshold_sd = threshold_sd;
  o.absorb_s = absorb;
  o.learn = learn;
  return o;
}

Schema<ForegroundParams> foreground_schema(const char* name, const char* summary) {
  using P = ForegroundParams;
  return Schema<P>(name, summary)
      .add("cell_px", &P::cell_px,
           {.unit = "px",
            .min = 1,
            .max = 20,
            .doc = "Full width at half maximum of a cell in the camera frame",
            .source = "assumed"})
      .add("cells", &P::cells,
           {.doc = "Cells darker or brighter than the background; automatic: determined from the first frame",
            .choices = {"automatic", "dark", "bright"}})
      .add("threshold_sd", &P::threshold_sd,
           {.min = 2,
            .max = 100,
            .doc = "Detection threshold for cells, in standard deviations of the smoothed noise",
            .source = "H5"})
      .add("absorb", &P::absorb,
           {.unit = "s",
            .min = 1,
            .max = 1e6,
            .doc = "Time constant with which stationary objects become background",
            .source = "assumed"})
      .add(
          "learn", &P::learn,
          {.doc = "true: the background is updated over time; false: it is estimated from each frame alone"});
}

const Image<std::uint8_t>& camera_picture(const Observation& o, const Frame& frame) {
  if (!o.image)
    throw Error(Errc::usage, "estimator",
                "needs camera frames, but the camera provides none; set camera.sensor = \"frames\"");
  if (o.image->width != frame.width || o.image->height != frame.height)
    throw Error(Errc::usage, "estimator",
                fmt::format("the camera frame is {} x {} px; it must be {} x {} px, the size of the view",
                            o.image->width, o.image->height, frame.width, frame.height));
  return *o.image;
}

}  // namespace faba
