#pragma once
#include <array>
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "app/scenario/calibration_file.h"
#include "study/quality/quality.h"
#include "study/scale/ruler_table.h"
#include "vision/ruler/ruler.h"

namespace faba {

/// The estimator "mean of the ratios" of theory A20: true width over reading, um/px.
struct ScaleRatios {
  std::vector<double> each;
  double mean = 0;
  double sd = 0;             ///< n - 1 degrees of freedom
  double sd_population = 0;  ///< n degrees of freedom
  double sem = 0;            ///< standard error of the mean
};

/// A measured scale and its source.
struct ScaleMeasurement {
  double um_per_px = 0;          ///< from the regression
  std::array<double, 2> ci95{};  ///< 95 % confidence interval, um/px
  double residual_px = 0;        ///< standard deviation about the regression line
  ScaleRatios ratios;
  std::string source;  ///< the measured file
  std::vector<Warning> warnings;
};

/// The scale from a table of readings, by both estimators of theory A20. Regression: reading = intercept +
/// slope * width over all readings, um_per_px = 1 / slope. Ratios: one per width, of the width to the mean of
/// its readings.
struct TableScale : ScaleMeasurement {
  /// Excess of all readings due to the edges: the constant part of a reading.
  double intercept_px = 0;
  std::array<double, 2> intercept_ci95_px{};
  double slope_px_per_um = 0;
  std::array<double, 2> slope_ci95_px_per_um{};
  std::size_t readings = 0;
  std::vector<double> widths_um;  ///< each width once, ascending
  /// Standard deviation of readings of one width, pooled; empty when no width has two readings.
  std::optional<double> repeatability_px;
  double ratio_bias = 0;  ///< mean of the ratios over um_per_px, minus 1
  double spearman = 0;    ///< rank correlation of ratio and width
  double spearman_p = 0;  ///< p-value, two-sided

  /// Whether 0 is outside the 95 % interval of the intercept.
  bool edge_excess_significant() const;
};

/// The scale from a picture of a ruler. Regression: positions of the marks on their index. Ratios: one per
/// gap between neighbouring marks.
struct PictureScale : ScaleMeasurement {
  double tick_um = 0;  ///< distance between neighbouring marks of the finest division
  double pitch_px = 0, pitch_se_px = 0;
  int marks = 0;         ///< marks used for the regression
  int unused_marks = 0;  ///< detected marks that were not used
  double angle_deg = 0;  ///< see Ruler
  double mark_width_px = 0, mark_length_px = 0;
  bool dark = true;  ///< marks darker than the background
  int image_width = 0, image_height = 0;
};

/// Throws Error(input, name) with fewer than three readings or two widths, and when the readings do not
/// increase significantly with the width. `name` becomes the source.
TableScale measure_scale(const RulerReadings& readings, const std::string& name);

/// Scale from a ruler in the picture `name` whose finest marks are `tick_m` apart.
PictureScale measure_scale(const Ruler& ruler, double tick_m, const std::string& name);

/// The contents of the calibration file.
Calibration calibration_of(const TableScale& scale);
Calibration calibration_of(const PictureScale& scale);

}  // namespace faba
