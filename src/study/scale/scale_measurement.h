#pragma once
#include <array>
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "app/scenario/calibration_file.h"
#include "study/scale/ruler_table.h"
#include "vision/ruler/ruler.h"

namespace faba {

/// The estimator "mean of the ratios" of theory A20: each width divided by what it was read as, um/px.
struct ScaleRatios {
  std::vector<double> each;
  double mean = 0;
  double sd = 0;             ///< n - 1 degrees of freedom
  double sd_population = 0;  ///< n degrees of freedom
  double sem = 0;            ///< standard error of the mean
};

/// A scale and where it comes from.
struct ScaleMeasurement {
  double um_per_px = 0;          ///< from the regression
  std::array<double, 2> ci95{};  ///< ends of its 95 % interval, um/px
  double residual_px = 0;        ///< standard deviation about the regression line
  ScaleRatios ratios;
  std::string source;  ///< the file that it was measured from
};

/// The scale from a table of readings, by both estimators of theory A20. Regression: reading = intercept +
/// slope * width over all readings, um_per_px = 1 / slope. Ratios: one for each width, of it to the mean of
/// its readings.
struct TableScale : ScaleMeasurement {
  /// How much wider than it is everything was read, because of its edges: the constant part of a reading.
  double intercept_px = 0;
  std::array<double, 2> intercept_ci95_px{};
  double slope_px_per_um = 0;
  std::array<double, 2> slope_ci95_px_per_um{};
  std::size_t readings = 0;
  std::vector<double> widths_um;  ///< each width once, ascending
  /// Scatter of readings of one width about their mean, pooled; empty when no width was read twice.
  std::optional<double> repeatability_px;
  double ratio_bias = 0;  ///< mean of the ratios over um_per_px, less 1
  double spearman = 0;    ///< rank correlation of ratio with width
  double spearman_p = 0;  ///< probability of one as far from 0 by chance

  /// Whether 0 is outside the 95 % interval of the intercept.
  bool edge_excess_significant() const;
};

/// How far the marks of a ruler are to be trusted.
enum class MarkQuality { good, fair, poor };
const char* word_of(MarkQuality quality);

/// The scale from a picture of a ruler. Regression: of the places of the marks on their number. Ratios: one
/// for each gap between neighbouring marks.
struct PictureScale : ScaleMeasurement {
  double tick_um = 0;  ///< distance between neighbouring marks of the finest kind
  double pitch_px = 0, pitch_se_px = 0;
  int marks = 0;         ///< used for the regression
  int left_out = 0;      ///< marks that were found and not used
  double angle_deg = 0;  ///< see Ruler
  double mark_width_px = 0, mark_length_px = 0;
  bool dark = true;  ///< marks darker than the ground
  int image_width = 0, image_height = 0;
  MarkQuality quality = MarkQuality::poor;
};

/// Throws Error(input, name) with fewer than three readings or two widths, and when the readings do not grow
/// with the width beyond doubt. `name` becomes the source.
TableScale measure_scale(const RulerReadings& readings, const std::string& name);

/// Of a ruler in the picture `name` whose finest marks are `tick_m` apart.
PictureScale measure_scale(const Ruler& ruler, double tick_m, const std::string& name);

/// What goes into the calibration file.
Calibration calibration_of(const TableScale& scale);
Calibration calibration_of(const PictureScale& scale);

}  // namespace faba
