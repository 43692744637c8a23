#include "vision/render/microscope_params.h"

#include <fmt/format.h>

namespace faba {
namespace {

void describe_mode(Schema<MicroscopeParams>& s) {
  using P = MicroscopeParams;
  s.add("mode", &P::mode,
        {.doc =
             "bright_field: cells absorb light; phase_contrast: a cell has a halo of the opposite contrast; "
             "fluorescence: cells emit light on a dark background, and contrast, level and edge_contrast "
             "have no effect",
         .choices = {"bright_field", "phase_contrast", "fluorescence"}})
      .add(
          "halo", &P::halo,
          {.min = 0,
           .max = 1,
           .doc = "Phase contrast: integrated optical density of the halo over that of the cell; 1: the mean "
                  "light of the picture does not change",
           .source = "assumed (G5)"})
      .add("halo_width", &P::halo_width,
           {.unit = "m",
            .min = 1e-7,
            .max = 1e-4,
            .doc = "Phase contrast: Gaussian standard deviation of the halo before the blur",
            .source = "assumed (G5)"})
      .add("emission", &P::emission,
           {.min = 0,
            .max = 10,
            .doc = "Fluorescence: light at the centre of a cell that is much larger than the blur, before "
                   "bleaching, as a fraction of white",
            .source = "assumed"})
      .add("background_emission", &P::background_emission,
           {.min = 1e-3,
            .max = 1,
            .doc = "Fluorescence: light of the medium at the picture centre, as a fraction of white; it does "
                   "not bleach",
            .source = "assumed"})
      .add("bleaching_time", &P::bleaching_time,
           {.unit = "s",
            .min = 1e-3,
            .max = 1e9,
            .doc = "Fluorescence: time constant of the exponential decay of the emission of the cells; "
                   "default: no bleaching",
            .source = "first-order photobleaching [S45] (G5)"});
}

void describe_cells(Schema<MicroscopeParams>& s) {
  using P = MicroscopeParams;
  s.add("psf_sd", &P::psf_sd,
        {.unit = "m",
         .min = 0,
         .max = 1e-4,
         .doc = "Standard deviation of the Gaussian point-spread function in focus",
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
            .doc = "Length of a cell, end to end: a rod along its heading if the model has a heading, else a "
                   "round cell of the same area; default: cell_diameter (a coccus)",
            .source = "IT-1: a coccus (B2)"})
      .add("contrast", &P::contrast,
           {.min = -0.95,
            .max = 10,
            .doc = "Relative grey change at the centre of a cell that is much larger than the blur; "
                   "negative: dark on bright",
            .source = "assumed"})
      .add("depth_spread", &P::depth_spread,
           {.unit = "m",
            .min = 0,
            .max = 1e-3,
            .doc =
                "Standard deviation of the distances of the cells from the focal plane; drawn once per cell"})
      .add("depth_of_field", &P::depth_of_field,
           {.unit = "m",
            .min = 1e-7,
            .max = 1e-3,
            .doc = "Distance from focus at which the blur is larger by the square root of two",
            .source = "4 pi n psf_sd^2 / wavelength, a Gaussian beam in water, with the defaults above"});
}

void describe_light(Schema<MicroscopeParams>& s) {
  using P = MicroscopeParams;
  s.add("level", &P::level,
        {.min = 0,
         .max = 1,
         .doc = "Background intensity at the picture centre, as a fraction of white",
         .source = "148 of 255, as in a real suspension (G3)"})
      .add("vignetting", &P::vignetting,
           {.min = 0, .max = 1, .doc = "Fraction of the light lost in the corners", .source = "assumed"})
      .add("unevenness", &P::unevenness,
           {.min = 0,
            .max = 0.3,
            .doc = "Relative rms of the slow static variation of the background",
            .source = "assumed"})
      .add("edge_contrast", &P::edge_contrast,
           {.min = -0.99,
            .max = 5,
            .doc = "Relative grey change at the centre of the line along the drop edge; 0: no line",
            .source = "assumed"})
      .add(
          "edge_width", &P::edge_width,
          {.unit = "m",
           .min = 0,
           .max = 1e-3,
           .doc = "Gaussian standard deviation of the line and of the step at the drop edge, before the blur",
           .source = "assumed"})
      .add("outside_level", &P::outside_level,
           {.min = 0,
            .max = 10,
            .doc = "Intensity outside the drop relative to the intensity inside; 1: no step",
            .source = "assumed"})
      .add("drift", &P::drift,
           {.unit = "1/s", .min = -1, .max = 1, .doc = "Relative change of the lamp intensity per second"})
      .add("flicker", &P::flicker,
           {.min = 0,
            .max = 0.3,
            .doc = "Relative standard deviation of the lamp intensity from frame to frame"})
      .add(
          "background", &P::background,
          {.doc =
               "Video or picture of the same size as the view; its temporal median and noise (0 for one "
               "picture) "
               "replace level, vignetting, unevenness, edge and noise. Path relative to the scene file or to "
               "the working directory"});
}

void describe_camera(Schema<MicroscopeParams>& s) {
  using P = MicroscopeParams;
  s.add("exposure_time", &P::exposure_time,
        {.unit = "s",
         .min = 0,
         .max = 1e3,
         .doc = "Exposure time of a frame, at most one frame period; default: the smaller of 10 ms and half "
                "the frame period",
         .source = "assumed"})
      .add("full_well", &P::full_well,
           {.min = 10,
            .max = 1e9,
            .doc = "Full-well capacity: electrons at white; the shot noise is the square root of the number "
                   "of electrons",
            .source = "with read_noise gives 2.2 grey levels of 255, as in a real suspension (G3)"})
      .add("read_noise", &P::read_noise,
           {.min = 0,
            .max = 1e6,
            .doc = "Standard deviation of the read noise, electrons",
            .source = "assumed"})
      .add("noise", &P::noise,
           {.min = 0,
            .max = 1,
            .doc = "Standard deviation of the noise as a fraction of white, independent of the grey value; "
                   "replaces shot noise and read noise; 0: no noise"})
      .add("bits", &P::bits, {.min = 8, .max = 16, .doc = "Bits per grey value: 8 or 16"});
}

}  // namespace

Schema<MicroscopeParams> MicroscopeParams::schema() {
  using P = MicroscopeParams;
  Schema<P> s("microscope",
              "Model of the camera picture: with camera.sensor = \"frames\" or record.as_seen = true");
  describe_mode(s);
  describe_cells(s);
  describe_light(s);
  describe_camera(s);
  return s
      .check([](const P& p) -> std::string {
        if (p.length() < p.cell_diameter) return "cell_length must not be smaller than cell_diameter";
        if (p.bits != 8 && p.bits != 16) return fmt::format("bits = {}; it must be 8 or 16", p.bits);
        return {};
      })
      .validity(
          "In bright field, cells absorb or scatter light but do not refract it: a dark cell has no bright "
          "fringe. A cell out of focus has no diffraction rings, a halo no shade-off, and all fluorescent "
          "cells are equally bright.");
}

void MicroscopeParams::settle(MicroscopeParams& p, const Node& n) {
  if (p.background.empty()) return;
  p.background = std::filesystem::absolute(n.file(p.background)).lexically_normal().string();
}

}  // namespace faba
