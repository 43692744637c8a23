#include "vision/render/microscope_params.h"

namespace faba {
namespace {

void describe_cells(Schema<MicroscopeParams>& s) {
  using P = MicroscopeParams;
  s.add("psf_sd", &P::psf_sd,
        {.unit = "m",
         .min = 0,
         .max = 1e-4,
         .doc = "Gaussian sd of the point-spread function in focus",
         .source = "0.21 wavelength / NA [S33] with 0.55 um and NA 0.25, a 10x objective"})
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
            .doc = "Length of a cell, end to end: a rod along its heading where the model has one, else a "
                   "round cell of the same area; as its width, a coccus, when absent",
            .source = "IT-1: a coccus (B2)"})
      .add("contrast", &P::contrast,
           {.min = -0.95,
            .max = 10,
            .doc = "Relative change of grey at the middle of a cell that is much larger than the blur; "
                   "negative: dark on bright",
            .source = "assumed"})
      .add("depth_spread", &P::depth_spread,
           {.unit = "m",
            .min = 0,
            .max = 1e-3,
            .doc = "Sd of the cells' distances from the focal plane, drawn once for each cell"})
      .add("depth_of_field", &P::depth_of_field,
           {.unit = "m",
            .min = 1e-7,
            .max = 1e-3,
            .doc = "Distance from focus at which the blur has grown by the square root of two",
            .source = "4 pi n psf_sd^2 / wavelength, a Gaussian beam in water, with the defaults above"});
}

void describe_light(Schema<MicroscopeParams>& s) {
  using P = MicroscopeParams;
  s.add("level", &P::level,
        {.min = 0,
         .max = 1,
         .doc = "Light in the middle of the empty picture, as a share of white",
         .source = "148 of 255, as in a real suspension (G3)"})
      .add("vignetting", &P::vignetting,
           {.min = 0, .max = 1, .doc = "Share of the light lost in the corners", .source = "assumed"})
      .add("unevenness", &P::unevenness,
           {.min = 0,
            .max = 0.3,
            .doc = "Rms of the slow, fixed variation of the background, relative",
            .source = "assumed"})
      .add("edge_contrast", &P::edge_contrast,
           {.min = -0.99,
            .max = 5,
            .doc = "Relative change of grey in the middle of the line along the drop's edge; 0: no line",
            .source = "assumed"})
      .add("edge_width", &P::edge_width,
           {.unit = "m",
            .min = 0,
            .max = 1e-3,
            .doc = "Gaussian sd of that line and of the step across the edge, before the blur",
            .source = "assumed"})
      .add("outside_level", &P::outside_level,
           {.min = 0,
            .max = 10,
            .doc = "Light outside of the drop relative to the light inside; 1: no step",
            .source = "assumed"})
      .add("drift", &P::drift,
           {.unit = "1/s", .min = -1, .max = 1, .doc = "Relative change of the lamp per second"})
      .add("flicker", &P::flicker,
           {.min = 0, .max = 0.3, .doc = "Relative sd of the lamp from frame to frame"})
      .add("background", &P::background,
           {.doc = "Video of the view's size whose temporal median and noise are taken in place of level, "
                   "vignetting, unevenness, edge and noise; beside the scenario, or where the program is "
                   "called"});
}

void describe_camera(Schema<MicroscopeParams>& s) {
  using P = MicroscopeParams;
  s.add("exposure_time", &P::exposure_time,
        {.unit = "s",
         .min = 0,
         .max = 1e3,
         .doc = "How long one frame is exposed, at most one frame; 10 ms or half a frame, the shorter, when "
                "absent",
         .source = "assumed"})
      .add("full_well", &P::full_well,
           {.min = 10,
            .max = 1e9,
            .doc = "Electrons at white: shot noise is the square root of their number",
            .source = "with read_noise gives 2.2 grey levels of 255, as in a real suspension (G3)"})
      .add("read_noise", &P::read_noise,
           {.min = 0, .max = 1e6, .doc = "Noise of the empty camera, electrons, sd", .source = "assumed"})
      .add(
          "noise", &P::noise,
          {.min = 0,
           .max = 1,
           .doc =
               "Noise as a share of white, the same everywhere, in place of shot and read noise; 0 for none"})
      .add("bits", &P::bits, {.min = 8, .max = 16, .doc = "Bits of a grey value, 8 or 16"});
}

}  // namespace

Schema<MicroscopeParams> MicroscopeParams::schema() {
  using P = MicroscopeParams;
  Schema<P> s("microscope",
              "How the camera sees the cells: with camera.sensor = \"frames\" or record.as_seen = true");
  describe_cells(s);
  describe_light(s);
  describe_camera(s);
  return s
      .check([](const P& p) -> std::string {
        if (p.length() < p.cell_diameter)
          return "cell_length is the longer side: it cannot be below cell_diameter";
        if (p.bits != 8 && p.bits != 16) return "bits must be 8 or 16";
        return {};
      })
      .validity(
          "Cells absorb or scatter and do not bend light: no bright fringe around a dark cell, no "
          "rings out of focus.");
}

void MicroscopeParams::settle(MicroscopeParams& p, const Node& n) {
  if (p.background.empty()) return;
  p.background = std::filesystem::absolute(n.file(p.background)).lexically_normal().string();
}

}  // namespace faba
