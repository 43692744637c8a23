#include "study/optics/optics_setup.h"

#include <fmt/format.h>

namespace faba {
namespace {

OpticsSetup objective(double magnification, double numerical_aperture) {
  OpticsSetup o;
  o.magnification = magnification;
  o.numerical_aperture = numerical_aperture;
  return o;
}

void describe_objective(Schema<OpticsSetup>& s) {
  using P = OpticsSetup;
  s.preset("10x", objective(10, 0.25), "Nikon CFI 10x of the thesis, appendix A; NA 0.25 assumed")
      .preset("100x", objective(100, 1.4),
              "Nikon CFI Plan Apo VC 100x Oil of the thesis, appendix A; NA 1.4: Nikon, not looked up")
      .preset("4x", objective(4, 0.1), "typical achromat, assumed")
      .preset("20x", objective(20, 0.4), "typical achromat, assumed")
      .preset("40x", objective(40, 0.65), "typical achromat, assumed");
  s.add("magnification", &P::magnification,
        {.min = 0.1,
         .max = 500,
         .doc = "Magnification of the objective, as engraved on it",
         .source = "Nikon CFI 10x of the thesis, appendix A"})
      .add("numerical_aperture", &P::numerical_aperture,
           {.min = 0.01,
            .max = 1.7,
            .doc = "Numerical aperture of the objective",
            .source = "assumed for the objective 10x of the thesis"})
      .add(
          "um_per_px", &P::um_per_px,
          {.min = 1e-4,
           .max = 1000,
           .doc = "Image scale, um per px; default: that of the thesis, 0.8015 at 10x, times 10 over the "
                  "magnification",
           .source = "thesis, table 4.1: measured at 10x only; a fit to the same readings gives 0.9164 (A20)",
           .title = "Image scale, um per px"})
      .add("pixel_size", &P::pixel_size,
           {.unit = "m",
            .min = 1e-7,
            .max = 1e-3,
            .doc = "Size of a pixel of the camera sensor; the scale is then computed from it, the "
                   "magnification and tube_factor"})
      .add("tube_factor", &P::tube_factor,
           {.min = 0.01,
            .max = 100,
            .doc = "Focal length of the tube lens over the one for which the objective is designed, times "
                   "that of any relay; used with pixel_size. The thesis: 0.75, a lens of 150 mm (appendix A) "
                   "over "
                   "200 mm (Nikon CFI, not looked up)",
            .source = "the tube lens for which the objective is designed, without a relay"});
}

void describe_camera(Schema<OpticsSetup>& s) {
  using P = OpticsSetup;
  s.add("width_px", &P::width_px,
        {.min = 16, .max = 100000, .doc = "Width of the pictures, px", .source = "thesis, section 4.3"})
      .add("height_px", &P::height_px,
           {.min = 16, .max = 100000, .doc = "Height of the pictures, px", .source = "thesis, section 4.3"})
      .add("frame_rate", &P::frame_rate,
           {.unit = "Hz",
            .min = 1e-3,
            .max = 1e6,
            .doc = "Frames per second",
            .source = "thesis, section 3.4.1: 90 frames in 6 s"})
      .add("exposure_time", &P::exposure_time,
           {.unit = "s",
            .min = 0,
            .max = 1e3,
            .doc = "Exposure time of a frame, at most one frame period; default: the smaller of 10 ms and "
                   "half the frame period",
            .source = "assumed"});
}

void describe_sample(Schema<OpticsSetup>& s) {
  using P = OpticsSetup;
  s.add("speed", &P::speed,
        {.unit = "m/s",
         .min = 1e-9,
         .max = 1,
         .doc = "Swimming speed of the cells",
         .source = "IT-1: mean of the thesis"})
      .add("cell_diameter", &P::cell_diameter,
           {.unit = "m",
            .min = 1e-7,
            .max = 1e-4,
            .doc = "Width of a cell",
            .source = "IT-1: R = 0.7 um (B2)"})
      .add("cell_length", &P::cell_length,
           {.unit = "m",
            .min = 1e-7,
            .max = 1e-4,
            .doc = "Length of a cell, end to end; default: cell_diameter (a coccus)",
            .source = "IT-1: a coccus (B2)"})
      .add("cells_per_mm2", &P::cells_per_mm2,
           {.min = 0.01,
            .max = 1e7,
            .doc = "Cells in focus per square millimetre of the picture",
            .source = "assumed: 200 cells in view at 10x",
            .title = "Cells per square millimetre"})
      .add("drop_radius", &P::drop_radius,
           {.unit = "m",
            .min = 1e-6,
            .max = 1,
            .doc = "Radius of the drop, in the plane of the picture",
            .source = "assumed, as in scenes/as-seen.toml"});
}

}  // namespace

Schema<OpticsSetup> OpticsSetup::schema() {
  Schema<OpticsSetup> s("optics", "Objective, camera and sample of a planned experiment");
  describe_objective(s);
  describe_camera(s);
  describe_sample(s);
  return s.check([](const OpticsSetup& o) -> std::string {
    if (o.um_per_px && o.pixel_size)
      return "um_per_px and pixel_size are two ways to state the scale; give one of them";
    if (o.exposure_time && *o.exposure_time > 1 / o.frame_rate)
      return fmt::format("exposure_time is {:g} s; it must be at most the frame period, {:g} s",
                         *o.exposure_time, 1 / o.frame_rate);
    if (o.cell_length && *o.cell_length < o.cell_diameter)
      return "cell_length must not be smaller than cell_diameter";
    return {};
  });
}

}  // namespace faba
