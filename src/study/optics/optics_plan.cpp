#include "study/optics/optics_plan.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "core/units.h"
#include "vision/cells/spot_fit.h"

namespace faba {
namespace {

constexpr double kWavelength =
    0.55e-6;                    // m, assumed as in the rendered microscope: the maximum of white light
constexpr double kAiry = 0.21;  // sd of the Gaussian nearest to an Airy disc, wavelength / NA [S33]
constexpr double kFirstMinimum = 0.61;     // radius of the first minimum of an Airy disc, wavelength / NA
constexpr double kWater = 1.33;            // refractive index of the medium
constexpr double kLongestExposure = 0.01;  // s, the default of the rendered microscope
constexpr double kEdgeError = 1;           // px, of a point of the edge, independent between pixels; assumed

double scale_of(const OpticsSetup& o) {
  if (o.um_per_px) return *o.um_per_px;
  if (o.pixel_size) return 1e6 * *o.pixel_size / (o.magnification * o.tube_factor);
  return kThesisUmPerPx * 10 / o.magnification;
}

// The cell is a rod along its motion.
void add_object(OpticsPlan& p) {
  const double m_per_px = 1e-6 * p.um_per_px;
  const double across = std::pow(p.psf_sd / m_per_px, 2) + p.cell_px * p.cell_px / 16 + 1.0 / 12;
  const double rod = p.cell_length_px - p.cell_px;
  const double along = across + rod * rod / 12 + p.blur_px * p.blur_px / 12;
  p.object_px = kFwhmPerSd * std::pow(across * along, 0.25);
  p.object_across_px = kFwhmPerSd * std::sqrt(across);
}

// The arc of a drop whose edge crosses the view from its lower to its upper border, and the relative standard
// error of a circle that is fitted to one edge point per px: sd(R) = e sqrt(45 / n) / half_arc^2 for a short
// arc [S26]; a complete circle has sd(R) = e / sqrt(n).
void add_drop(OpticsPlan& p, const OpticsSetup& o) {
  const double half = std::asin(std::min(1.0, p.view_height / 2 / o.drop_radius));
  const bool complete = 2 * o.drop_radius <= p.view_height;
  p.arc_deg = complete ? 360 : 2 * half * kDegreesPerRadian;
  const double radius_px = 1e6 * o.drop_radius / p.um_per_px;
  const double points = std::max(1.0, radius_px * (complete ? 2 * std::numbers::pi : 2 * half));
  const double error = kEdgeError / std::sqrt(points) * (complete ? 1 : std::sqrt(45.0) / (half * half));
  p.radius_error = error / radius_px;
}

}  // namespace

OpticsPlan optics_plan(const OpticsSetup& o) {
  OpticsPlan p;
  p.um_per_px = scale_of(o);
  const double m_per_px = 1e-6 * p.um_per_px;
  p.view_width = o.width_px * m_per_px;
  p.view_height = o.height_px * m_per_px;
  p.cell_px = o.cell_diameter / m_per_px;
  p.cell_length_px = o.cell_length.value_or(o.cell_diameter) / m_per_px;
  const double cells_per_m2 = 1e6 * o.cells_per_mm2;
  p.cells_in_view = cells_per_m2 * p.view_width * p.view_height;
  p.spacing_px = 1 / std::sqrt(cells_per_m2) / m_per_px;
  p.crossing_time = p.view_width / o.speed;
  p.crossing_frames = p.crossing_time * o.frame_rate;
  p.displacement_px = o.speed / o.frame_rate / m_per_px;
  p.exposure_time = o.exposure_time.value_or(std::min(kLongestExposure, 0.5 / o.frame_rate));
  p.blur_px = o.speed * p.exposure_time / m_per_px;
  p.resolution = kFirstMinimum * kWavelength / o.numerical_aperture;
  p.psf_sd = kAiry * kWavelength / o.numerical_aperture;
  p.depth_of_field = 4 * std::numbers::pi * kWater * p.psf_sd * p.psf_sd / kWavelength;
  add_object(p);
  // The mean distance of the points of a disc from its border along one direction is 8 R / (3 pi).
  p.gathering_time = 8 * o.drop_radius / (3 * std::numbers::pi) / o.speed;
  add_drop(p, o);
  return p;
}

}  // namespace faba
