#include "study/pages/scale_report.h"

#include <fmt/format.h>
#include <cmath>
#include <nlohmann/json.hpp>

#include "core/error.h"
#include "core/toml.h"
#include "study/pages/quality_output.h"
#include "vision/draw/ruler_overlay.h"
#include "vision/files/picture.h"

namespace faba {
namespace {

void add_ratios(Json& j, const ScaleRatios& r) {
  j["ratios"] = r.each;
  j["ratio_mean"] = r.mean;
  j["ratio_sd"] = r.sd;
  j["ratio_sd_population"] = r.sd_population;
  j["ratio_sem"] = r.sem;
}

// Fields common to both kinds of scales.
template <class Scale>
void add_advice(Json& j, const Scale& s) {
  j["recommended"] = "regression";
  j["note"] = scale_note(s);
  j["method"] = calibration_of(s).method;
  j["source"] = s.source;
  add_quality(j, s.warnings);
}

}  // namespace

std::string scale_note(const TableScale& s) {
  const bool larger = s.intercept_px > 0;
  const double low = larger ? s.intercept_ci95_px[0] : -s.intercept_ci95_px[1];
  const double high = larger ? s.intercept_ci95_px[1] : -s.intercept_ci95_px[0];
  const std::string range =
      fmt::format("{:.1f} px (95 % interval {:.1f} to {:.1f})", std::fabs(s.intercept_px), low, high);
  if (s.edge_excess_significant())
    return fmt::format(
        "every reading is {} too {}, independent of the width (edge effect). Use the regression; the "
        "mean of the ratios is biased by {:+.1f} %",
        range, larger ? "large" : "small", 100 * s.ratio_bias);
  return fmt::format(
      "the constant offset of the readings, {}, is not significantly different from 0, so no bias of either "
      "estimator is detected. Use the regression, unless you know that the readings have no edge "
      "effect",
      range);
}

std::string scale_note(const PictureScale&) {
  return "measured between the centres of the marks, so the width of the marks has no effect; the interval "
         "includes only the scatter, not lens distortion or the tolerance of the ruler";
}

nlohmann::ordered_json scale_json(const TableScale& s) {
  Json j;
  j["um_per_px"] = s.um_per_px;
  j["ci95"] = s.ci95;
  j["intercept_px"] = s.intercept_px;
  j["intercept_ci95_px"] = s.intercept_ci95_px;
  j["slope_px_per_um"] = s.slope_px_per_um;
  j["slope_ci95_px_per_um"] = s.slope_ci95_px_per_um;
  j["residual_px"] = s.residual_px;
  j["readings"] = s.readings;
  j["widths_um"] = s.widths_um;
  add_ratios(j, s.ratios);
  j["repeatability_px"] = s.repeatability_px ? Json(*s.repeatability_px) : Json();
  j["edge_excess_px"] = s.intercept_px;
  j["edge_excess_significant"] = s.edge_excess_significant();
  j["ratio_bias"] = s.ratio_bias;
  j["spearman"] = s.spearman;
  j["spearman_p"] = s.spearman_p;
  add_advice(j, s);
  return j;
}

nlohmann::ordered_json scale_json(const PictureScale& s) {
  Json j;
  j["um_per_px"] = s.um_per_px;
  j["ci95"] = s.ci95;
  j["tick_um"] = s.tick_um;
  j["pitch_px"] = s.pitch_px;
  j["pitch_se_px"] = s.pitch_se_px;
  j["residual_px"] = s.residual_px;
  j["marks"] = s.marks;
  j["unused_marks"] = s.unused_marks;
  j["angle_deg"] = s.angle_deg;
  j["mark_width_px"] = s.mark_width_px;
  j["mark_length_px"] = s.mark_length_px;
  j["mark_polarity"] = s.dark ? "dark" : "bright";
  add_ratios(j, s.ratios);
  j["image_size"] = {s.image_width, s.image_height};
  add_advice(j, s);
  return j;
}

namespace {

GrayF ruler_picture(const std::filesystem::path& picture) {
  try {
    return read_picture(picture).grey;
  } catch (const Error& e) {
    std::error_code ec;
    if (!std::filesystem::is_regular_file(picture, ec)) throw;
    throw Error(e.code(), e.where(),
                e.reason() + "; a table of readings needs the extension .csv, .tsv, .txt or .dat");
  }
}

}  // namespace

void check_ruler_picture(const std::filesystem::path& picture) { (void)ruler_picture(picture); }

PictureScale report_scale_picture(const std::filesystem::path& picture, double tick_m,
                                  const std::filesystem::path& overlay) {
  const GrayF grey = ruler_picture(picture);
  RulerOptions options;
  options.name = picture.string();
  const Ruler ruler = find_ruler(grey, options);
  if (!overlay.empty()) write_png(overlay, ruler_overlay(read_displayed(picture), ruler));
  return measure_scale(ruler, tick_m, picture.string());
}

}  // namespace faba
