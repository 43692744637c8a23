#include "study/scale/scale_measurement.h"

#include <algorithm>
#include <cmath>
#include <map>

#include <fmt/format.h>

#include "core/error.h"
#include "core/random/distributions.h"
#include "study/stats/statistics.h"

namespace faba {
namespace {

ScaleRatios ratios_of(std::vector<double> values) {
  const double n = double(values.size());
  ScaleRatios r;
  r.mean = mean(values);
  r.sd = sample_sd(values);
  r.sd_population = r.sd * std::sqrt((n - 1) / n);
  r.sem = r.sd / std::sqrt(n);
  r.each = std::move(values);
  return r;
}

std::optional<double> repeatability(const std::map<double, std::vector<double>>& by_width) {
  double squares = 0, freedom = 0;
  for (const auto& [width, list] : by_width) {
    const double sd = sample_sd(list);
    squares += sd * sd * double(list.size() - 1);
    freedom += double(list.size() - 1);
  }
  if (freedom == 0) return std::nullopt;
  return std::sqrt(squares / freedom);
}

// Too few or too irregular marks. The limits are assumed.
std::vector<Warning> warnings_of(const MarkRow& row) {
  const double relative_residual = row.residual_px / row.pitch_px;
  const int used = row.used();
  if (relative_residual < 0.02 && used >= 20) return {};
  const bool usable = relative_residual < 0.05 && used >= 8;
  return {{"marks", "the detected marks are few or irregular",
           fmt::format("{} marks, scatter {:.2g} % of their spacing", used, 100 * relative_residual),
           "check them with --overlay; use a picture with more marks in focus",
           usable ? Quality::doubtful : Quality::poor}};
}

// Whether the readings bend: t-value of a square of the width beside the line, and the relative change of the
// slope between the ends that it causes.
struct Curvature {
  double t = 0, change = 0;
  int freedom = 0;
};

// Of the mean readings of each width: readings of one width have the error of that width in common.
Curvature curvature_of(const std::map<double, std::vector<double>>& by_width) {
  std::vector<double> width, px, square;
  for (const auto& [w, list] : by_width) {
    width.push_back(w);
    px.push_back(mean(list));
    square.push_back(w * w);
  }
  const int n = int(width.size());
  if (n < 5) return {};
  const LineFit line = fit_line(width, px), of_square = fit_line(width, square);
  double qq = 0, qr = 0, rr = 0;
  for (std::size_t i = 0; i < width.size(); ++i) {
    const double q = square[i] - of_square.intercept - of_square.slope * width[i];
    const double r = px[i] - line.intercept - line.slope * width[i];
    qq += q * q;
    qr += q * r;
    rr += r * r;
  }
  const double c = qr / qq, rest = std::max(0.0, rr - c * qr);
  return {c / std::sqrt(std::max(rest / (n - 3), 1e-12) / qq),
          2 * c * (width.back() - width.front()) / line.slope, n - 3};
}

Warning curvature_warning(const Curvature& bend) {
  return {"linearity",
          "the readings are not proportional to the width: distortion of the lens, or a wrong width",
          fmt::format("the slope changes by {:.0f} % from the smallest to the largest width (t = {:.1f})",
                      100 * bend.change, bend.t),
          "measure in the middle of the picture, and check the widths"};
}

// An uncertainty of the scale is one of every length and speed.
std::vector<Warning> warnings_of(const TableScale& s) {
  constexpr double kUncertain = 0.1, kUseless = 0.3;  // half of the 95 % interval over the scale, assumed
  const double relative = (s.ci95[1] - s.ci95[0]) / 2 / s.um_per_px;
  if (relative <= kUncertain) return {};
  return {{"readings", "the readings do not determine the scale well",
           fmt::format("the 95 % interval is +- {:.0f} %", 100 * relative), "add readings, of more widths",
           relative > kUseless ? Quality::poor : Quality::doubtful}};
}

// Ratios of the gaps between neighbouring marks, um/px.
std::vector<double> gap_ratios(const MarkRow& row, double tick_um) {
  std::vector<double> ratios;
  const RowMark* before = nullptr;
  for (const RowMark& m : row.marks) {
    if (!m.used) continue;
    if (before) ratios.push_back(tick_um * (m.index - before->index) / (m.s - before->s));
    before = &m;
  }
  return ratios;
}

void require_line(std::size_t readings, const std::map<double, std::vector<double>>& by_width,
                  const std::string& name) {
  const std::size_t widths = by_width.size();
  if (widths >= 2 && readings >= 3) return;
  throw Error(Errc::input, name,
              fmt::format("has {}{}; at least three readings of at least two widths are needed",
                          readings == 1 ? "one reading" : fmt::format("{} readings", readings),
                          widths == 1 ? fmt::format(", all of the width {:g} um", by_width.begin()->first)
                                      : fmt::format(" of {} widths", widths)));
}

Calibration calibration_with(const ScaleMeasurement& scale, std::string method) {
  return {scale.um_per_px, Vec2{scale.ci95[0], scale.ci95[1]}, std::move(method), scale.source};
}

}  // namespace

bool TableScale::edge_excess_significant() const {
  return intercept_ci95_px[0] > 0 || intercept_ci95_px[1] < 0;
}

TableScale measure_scale(const RulerReadings& readings, const std::string& name) {
  std::map<double, std::vector<double>> by_width;
  std::vector<double> width_um;
  for (std::size_t i = 0; i < readings.width_m.size(); ++i) {
    // Units are binary factors with rounding errors: 30 um must be 30, not 29.999999999999996.
    width_um.push_back(std::round(readings.width_m[i] * 1e18) / 1e12);
    by_width[width_um.back()].push_back(readings.reading_px[i]);
  }
  require_line(width_um.size(), by_width, name);
  const LineFit line = fit_line(width_um, readings.reading_px);
  TableScale s;
  s.slope_px_per_um = line.slope;
  s.slope_ci95_px_per_um = line.slope_ci95();
  if (!(s.slope_ci95_px_per_um[0] > 0))
    throw Error(Errc::input, name,
                fmt::format("the readings do not increase significantly with the width (slope {:.3g} px/um, "
                            "95 % confidence interval {:.3g} to {:.3g}); check that the columns are not "
                            "exchanged",
                            line.slope, s.slope_ci95_px_per_um[0], s.slope_ci95_px_per_um[1]));
  s.um_per_px = 1 / line.slope;
  s.ci95 = {1 / s.slope_ci95_px_per_um[1], 1 / s.slope_ci95_px_per_um[0]};
  s.intercept_px = line.intercept;
  s.intercept_ci95_px = line.intercept_ci95();
  s.residual_px = line.sd;
  s.readings = width_um.size();
  std::vector<double> ratios;
  for (const auto& [width, list] : by_width) {
    s.widths_um.push_back(width);
    ratios.push_back(width / mean(list));
  }
  s.repeatability_px = repeatability(by_width);
  s.spearman = spearman(s.widths_um, ratios);
  s.spearman_p = spearman_p(s.widths_um, ratios);
  s.ratios = ratios_of(std::move(ratios));
  s.ratio_bias = s.ratios.mean * line.slope - 1;
  s.source = name;
  s.warnings = warnings_of(s);
  // Significant at 1 %.
  const Curvature bend = curvature_of(by_width);
  if (bend.freedom > 0 && std::fabs(bend.t) > student_t_quantile(0.995, bend.freedom))
    s.warnings.push_back(curvature_warning(bend));
  return s;
}

PictureScale measure_scale(const Ruler& ruler, double tick_m, const std::string& name) {
  const MarkRow& row = ruler.row;
  const int used = row.used();
  const double half_ci = student_t_quantile(0.975, std::max(1, used - 2)) * row.se_pitch_px;
  PictureScale s;
  s.tick_um = tick_m * 1e6;
  s.um_per_px = s.tick_um / row.pitch_px;
  s.ci95 = {s.tick_um / (row.pitch_px + half_ci), s.tick_um / (row.pitch_px - half_ci)};
  s.pitch_px = row.pitch_px;
  s.pitch_se_px = row.se_pitch_px;
  s.residual_px = row.residual_px;
  s.marks = used;
  s.unused_marks = int(row.marks.size()) - used;
  s.angle_deg = ruler.angle_deg;
  s.mark_width_px = row.width_px;
  s.mark_length_px = row.height_px;
  s.dark = row.dark;
  s.ratios = ratios_of(gap_ratios(row, s.tick_um));
  s.image_width = ruler.image_width;
  s.image_height = ruler.image_height;
  s.warnings = warnings_of(row);
  s.source = name;
  return s;
}

Calibration calibration_of(const TableScale& scale) {
  return calibration_with(scale, "regression of readings on widths");
}

Calibration calibration_of(const PictureScale& scale) {
  return calibration_with(
      scale, fmt::format("{} marks of a ruler in a picture, {:g} um apart; quality {}", scale.marks,
                         scale.tick_um, word_of(quality_of(scale.warnings))));
}

}  // namespace faba
