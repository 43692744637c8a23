#pragma once
#include <filesystem>
#include <string>
#include <vector>

#include <nlohmann/json.hpp>

#include "app/scenario/calibration_file.h"

namespace faba {

/// Readings of a ruler's lines or distances: one width and the pixels it was read as, for each reading.
struct RulerReadings {
  std::vector<double> width_m;
  std::vector<double> reading_px;
};

/// Reads a table of readings: one column of widths, whose name says `width` or `um` and ends with a unit of
/// length
/// (`width_um`, `width (mm)`, `um`), and one or more of readings in pixels. When the names of some columns
/// say `px` or `pixel` those are the readings, else all others are. One row for each width with its readings
/// side by side, or one row for each reading. Throws Error(input) naming file and line for anything that is
/// not a positive number, for a missing unit and for no readings.
RulerReadings read_ruler_table(const std::filesystem::path& file);

/// The scale by both estimators of theory A20. Regression, reading = intercept + slope * width over all
/// readings: `um_per_px` = 1 / slope, `ci95`, `intercept_px`, `intercept_ci95_px`, `slope_px_per_um`,
/// `slope_ci95_px_per_um`, `residual_px`. Mean of the ratios of width to the mean reading of that width, one
/// for each width: `widths_um`, `ratios`, `ratio_mean`, `ratio_sd` (n - 1), `ratio_sd_population` (n),
/// `ratio_sem`. And what tells which to take: `repeatability_px` (null when nothing was read twice),
/// `edge_excess_px` (the intercept), `edge_excess_significant`, `ratio_bias` (the ratio-mean over the
/// regression, less 1), `spearman`, `spearman_p` (of ratio with width), `take` and `note`. Throws
/// Error(input, name) with fewer than three readings or two widths, and when the readings do not grow with
/// the width beyond doubt.
nlohmann::ordered_json scale_json(const RulerReadings& readings, const std::string& name);

/// read_ruler_table and scale_json, with `source` and `method`.
nlohmann::ordered_json report_scale_table(const std::filesystem::path& table);

/// The scale from a picture of a ruler whose finest marks are `tick_m` apart (find_ruler). `um_per_px` and
/// `ci95` from the regression of the marks' places on their number; `ratios`, `ratio_mean`, `ratio_sd`,
/// `ratio_sem` from the gaps between neighbouring marks; `pitch_px`, `pitch_se_px`, `angle_deg`, `marks`,
/// `left_out`, `residual_px`, `mark_width_px`, `mark_length_px`, `marks_are` ("dark", "bright"),
/// `image_size`, `quality`, `note`. Unless `overlay` is empty, writes the picture with the marks drawn in.
/// Throws Error(input) when there is no ruler in the picture.
nlohmann::ordered_json report_scale_picture(const std::filesystem::path& picture, double tick_m,
                                            const std::filesystem::path& overlay);

/// What goes into the calibration file of a report.
Calibration calibration_of(const nlohmann::ordered_json& report);

/// Whether a file is taken for a table of readings: its name ends in .csv, .tsv, .txt or .dat.
bool is_ruler_table(const std::filesystem::path& file);

}  // namespace faba
