#pragma once
#include "study/optics/optics_setup.h"

namespace faba {

/// What a setup gives, before any picture is taken. Lengths are in the plane of the sample.
///
/// Scale: s = um_per_px, or pixel_size / (magnification tube_factor). A cell crosses the view of width W in
/// W / v and moves by v / (rate s) px between frames and v t_E / s during the exposure. The optics are those
/// of the rendered microscope (theory G2): a Gaussian point-spread function of sd 0.21 wavelength / NA [S33],
/// a cell of diameter d adds d^2 / 16 to the variance, a pixel 1/12 px^2; the motion blur, uniform over b px,
/// adds b^2 / 12 along the motion. Assumptions: light of 0.55 um, cells in focus in water, small angles, so
/// that the depth of field of an oil objective is approximate.
struct OpticsPlan {
  double um_per_px = 0;
  double view_width = 0, view_height = 0;  ///< m
  double cell_px = 0, cell_length_px = 0;  ///< width and length of a cell
  double cells_in_view = 0;                ///< mean number
  double spacing_px = 0;                   ///< 1 / sqrt(cells per px^2), as in the warnings of tracking
  double crossing_time = 0;                ///< s, view width over speed
  double crossing_frames = 0;              ///< frames in this time
  double displacement_px = 0;              ///< between consecutive frames
  double exposure_time = 0;                ///< s
  double blur_px = 0;                      ///< displacement during the exposure
  double object_px = 0;  ///< full width at half maximum of the picture of a cell, of a round spot of its area
  double object_across_px = 0;  ///< the same across the motion
  double resolution = 0;        ///< m, Rayleigh: 0.61 wavelength / NA
  double psf_sd = 0;            ///< m, standard deviation of the point-spread function
  double depth_of_field = 0;    ///< m, from focus to a blur that is larger by sqrt(2)
  double gathering_time = 0;    ///< s, mean time in which cells reach the edge of the drop
  double arc_deg = 0;           ///< of the drop's edge across the view
  double radius_error = 0;      ///< relative standard error of the radius from this arc
};

OpticsPlan optics_plan(const OpticsSetup& setup);

}  // namespace faba
