#include "app/scenario/sections/scale.h"

namespace faba {

Schema<ScaleParams> ScaleParams::schema() {
  return Schema<ScaleParams>("scale", "Conversion of pixels, iterations and field units to SI")
      .add("um_per_px", &ScaleParams::um_per_px,
           {.min = 1e-3,
            .max = 1e3,
            .doc = "Micrometres per pixel",
            .source = "thesis's table 4.1 by regression (A20); the thesis itself used 0.8015",
            .title = "Image scale"})
      .add("nominal_um_per_px", &ScaleParams::nominal_um_per_px,
           {.min = 1e-3,
            .max = 1e3,
            .doc = "Micrometres per pixel for a picture whose scale is not known, instead of um_per_px: the "
                   "simulation uses it, and results are stated in pixels only",
            .title = "Nominal image scale"})
      .add("um_per_px_source", &ScaleParams::um_per_px_source,
           {.doc = "Origin of um_per_px, for the manifest; default: typed if um_per_px is given",
            .choices = {"default", "typed", "calibration", "metadata"},
            .title = "Source of the image scale"})
      .add("iteration", &ScaleParams::iteration,
           {.unit = "s",
            .min = 1e-5,
            .max = 100,
            .doc = "Duration of one iteration of the published models; default: one frame period",
            .title = "Duration of one iteration"})
      .add("field_unit", &ScaleParams::field_unit,
           {.unit = "T",
            .min = 1e-9,
            .max = 1,
            .doc = "One field unit of the published models",
            .source = "Earth's field near Rio (B2)"});
}

void ScaleParams::settle(ScaleParams& p, const Node& n) {
  if (!n.has("um_per_px")) {
    if (p.nominal_um_per_px) p.um_per_px.reset();
    p.um_per_px_source = Source::simulated;
    return;
  }
  p.nominal_um_per_px.reset();
  const auto origin = n.document->origin.find("scale.um_per_px");
  const bool set = origin != n.document->origin.end() && origin->second == "--set";
  if (set || !n.has("um_per_px_source")) p.um_per_px_source = Source::typed;
}

void ScaleParams::require_known() {
  if (!um_per_px || um_per_px_source != Source::simulated) return;
  nominal_um_per_px = um_per_px;
  um_per_px.reset();
}

Json scale_source_json(const ScaleParams& p) {
  if (!p.um_per_px || p.um_per_px_source == ScaleParams::Source::simulated) return {};
  return ScaleParams::schema().to_json(p)["um_per_px_source"];
}

Json hashed_scale(const ScaleParams& p) {
  Json j = ScaleParams::schema().to_json(p);
  j.erase("um_per_px_source");
  return j;
}

Json calibration_file_json_schema() {
  return {{"type", "string"},
          {"description", "Calibration file written by `faba scale`, in place of um_per_px"}};
}

}  // namespace faba
