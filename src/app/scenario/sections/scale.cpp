#include "app/scenario/sections/scale.h"

namespace faba {

Schema<ScaleParams> ScaleParams::schema() {
  return Schema<ScaleParams>("scale", "Conversion of pixels, iterations and field units to SI")
      .add("um_per_px", &ScaleParams::um_per_px,
           {.min = 1e-3,
            .max = 1e3,
            .doc = "Micrometres per pixel",
            .source = "thesis's table 4.1 by regression (A20); the thesis itself used 0.8015"})
      .add("iteration", &ScaleParams::iteration,
           {.unit = "s",
            .min = 1e-5,
            .max = 100,
            .doc = "Duration of one iteration of the published models; default: one frame period"})
      .add("field_unit", &ScaleParams::field_unit,
           {.unit = "T",
            .min = 1e-9,
            .max = 1,
            .doc = "One field unit of the published models",
            .source = "Earth's field near Rio (B2)"});
}

Json calibration_file_json_schema() {
  return {{"type", "string"},
          {"description", "Calibration file written by `faba scale`, in place of um_per_px"}};
}

}  // namespace faba
