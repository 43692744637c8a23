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
            .doc = "Width of a cell in the picture at half its contrast",
            .source = "assumed"})
      .add("cells", &P::cells,
           {.doc = "Darker or brighter than the background; told by the first picture when automatic",
            .choices = {"automatic", "dark", "bright"}})
      .add("threshold_sd", &P::threshold_sd,
           {.min = 2,
            .max = 100,
            .doc =
                "Standard deviations of the smoothed noise from which on a place counts as covered by cells",
            .source = "H5"})
      .add("absorb", &P::absorb,
           {.unit = "s",
            .min = 1,
            .max = 1e6,
            .doc = "Time in which what stands still becomes background",
            .source = "assumed"})
      .add("learn", &P::learn, {.doc = "false: the background is found in each picture anew"});
}

const Image<std::uint8_t>& camera_picture(const Observation& o, const Frame& frame) {
  if (!o.image)
    throw Error(Errc::usage, "estimator",
                "looks at pictures, and the camera gives none; set camera.sensor = \"frames\"");
  if (o.image->width != frame.width || o.image->height != frame.height)
    throw Error(Errc::usage, "estimator",
                fmt::format("the camera's picture has {} x {} px, the view {} x {}", o.image->width,
                            o.image->height, frame.width, frame.height));
  return *o.image;
}

}  // namespace faba
