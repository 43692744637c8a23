#pragma once
#include <filesystem>
#include <string>

#include <nlohmann/json_fwd.hpp>

#include "study/scale/scale_measurement.h"

namespace faba {

/// A scale from a table as reported by the command line: `um_per_px`, `ci95`, `intercept_px`,
/// `intercept_ci95_px`, `slope_px_per_um`, `slope_ci95_px_per_um`, `residual_px`, `readings`, `widths_um`,
/// `ratios`, `ratio_mean`, `ratio_sd`, `ratio_sd_population`, `ratio_sem`, `repeatability_px` (null when no
/// width was read twice), `edge_excess_px` (the intercept), `edge_excess_significant`, `ratio_bias`,
/// `spearman`, `spearman_p`, `recommended`, `note`, `method`, `source`.
nlohmann::ordered_json scale_json(const TableScale& scale);

/// A scale from a picture as reported by the command line and the lab: `um_per_px`, `ci95`, `tick_um`,
/// `pitch_px`, `pitch_se_px`, `residual_px`, `marks`, `unused_marks`, `angle_deg`, `mark_width_px`,
/// `mark_length_px`, `mark_polarity` ("dark", "bright"), the ratios as above, `image_size`, `quality`,
/// `recommended`, `note`, `method`, `source`.
nlohmann::ordered_json scale_json(const PictureScale& scale);

/// Recommended estimator, and the reason.
std::string scale_note(const TableScale& scale);
std::string scale_note(const PictureScale& scale);

/// Throws Error(input) unless the file can be read as a picture.
void check_ruler_picture(const std::filesystem::path& picture);

/// Measures the scale from a picture of a ruler with a distance of `tick_m` between its finest marks
/// (find_ruler). Unless `overlay` is empty, writes the picture with the marks drawn in. Throws Error(input)
/// when no ruler is detected.
PictureScale report_scale_picture(const std::filesystem::path& picture, double tick_m,
                                  const std::filesystem::path& overlay);

}  // namespace faba
