#include "study/pages/scale.h"

#include <fmt/format.h>

#include <algorithm>
#include <cctype>
#include <cmath>
#include <map>
#include <nlohmann/json.hpp>
#include <numeric>
#include <optional>
#include <stdexcept>

#include "core/distributions.h"
#include "core/table.h"
#include "core/units.h"
#include "study/stats/statistics.h"
#include "vision/draw/ruler_overlay.h"
#include "vision/files/picture.h"
#include "vision/ruler/ruler.h"

namespace faba {
namespace {

using Report = nlohmann::ordered_json;

std::string lower(std::string text) {
  std::transform(text.begin(), text.end(), text.begin(),
                 [](unsigned char c) { return char(std::tolower(c)); });
  return text;
}

/// The words of a column's name: what stands between spaces, underscores and brackets.
std::vector<std::string> words_of(const std::string& name) {
  std::vector<std::string> words(1);
  for (char c : name) {
    if (std::string_view(" _-()[]/,;:").find(c) == std::string_view::npos)
      words.back() += c;
    else if (!words.back().empty())
      words.emplace_back();
  }
  if (words.back().empty()) words.pop_back();
  return words;
}

bool says_pixels(const std::string& name) {
  const std::string n = lower(name);
  return n.find("px") != std::string::npos || n.find("pixel") != std::string::npos;
}

/// The unit of length that a name ends with, in m.
std::optional<double> length_unit(const std::string& name) {
  const auto words = words_of(name);
  if (words.empty() || says_pixels(name)) return std::nullopt;
  std::string unit = words.back();
  if (lower(unit) == "micron" || lower(unit) == "microns") unit = "um";
  try {
    const Quantity q = parse_unit(unit);
    if (q.dimension == parse_unit("m").dimension) return q.value;
  } catch (const std::invalid_argument&) {
  }
  return std::nullopt;
}

/// Name and unit of the column of widths.
std::pair<std::string, double> width_column(const Table& table) {
  std::vector<std::pair<std::string, double>> found;
  for (const std::string& name : table.names())
    if (const auto unit = length_unit(name)) found.emplace_back(name, *unit);
  if (found.size() == 1) return found.front();
  if (found.empty())
    throw Error(
        Errc::input, table.source(),
        "has no column of widths with their unit, such as width_um (or width_mm), beside the readings in "
        "px");
  throw Error(Errc::input, table.source(),
              fmt::format("has two columns of lengths, {} and {}; name the readings in pixels px_1, px_2 ...",
                          found[0].first, found[1].first));
}

double positive(const Table& table, const std::string& column, std::size_t row) {
  const double v = table.column(column)[row];
  if (v > 0) return v;
  throw Error(Errc::input, table.place(row),
              std::isnan(v)
                  ? fmt::format("{} is empty or not a number; with unequal numbers of readings write "
                                "one row for each: width_um,px",
                                column)
                  : fmt::format("{} is {}; it must be above 0", column, v));
}

/// Mean, both standard deviations and standard error of the ratios.
void add_ratios(Report& j, const std::vector<double>& ratios) {
  const double n = double(ratios.size()), sd = sample_sd(ratios);
  j["ratios"] = ratios;
  j["ratio_mean"] = mean(ratios);
  j["ratio_sd"] = sd;
  j["ratio_sd_population"] = sd * std::sqrt((n - 1) / n);
  j["ratio_sem"] = sd / std::sqrt(n);
}

/// Scatter of readings of one width about their mean, pooled; nothing when no width was read twice.
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

std::string advice(const Report& j) {
  const double excess = j["edge_excess_px"], bias = j["ratio_bias"];
  const auto& ci = j["intercept_ci95_px"];
  const std::string range =
      fmt::format("{:.1f} px (95 % {:.1f} to {:.1f})", excess, ci[0].get<double>(), ci[1].get<double>());
  if (j["edge_excess_significant"].get<bool>())
    return fmt::format(
        "every reading is {} too {}, whatever the width: edges, not scale. Take the regression; the mean of "
        "the ratios is off by {:+.1f} %",
        range, excess > 0 ? "wide" : "narrow", 100 * bias);
  return fmt::format(
      "the constant part of the readings, {}, may be 0: both estimators are free of bias as far as "
      "this table tells. Take the regression unless you know that edges do not matter",
      range);
}

}  // namespace

bool is_ruler_table(const std::filesystem::path& file) {
  const std::string end = lower(file.extension().string());
  return end == ".csv" || end == ".tsv" || end == ".txt" || end == ".dat";
}

RulerReadings read_ruler_table(const std::filesystem::path& file) {
  const Table table = read_table(file);
  const auto [width, unit] = width_column(table);
  std::vector<std::string> columns;
  const auto& names = table.names();
  const bool named = std::any_of(names.begin(), names.end(), says_pixels);
  for (const std::string& name : names)
    if (name != width && (!named || says_pixels(name))) columns.push_back(name);
  if (columns.empty())
    throw Error(Errc::input, table.source(), "has no column of readings in pixels beside " + width);
  if (table.size() == 0) throw Error(Errc::input, table.source(), "has no readings below its header");
  RulerReadings out;
  for (std::size_t row = 0; row < table.size(); ++row)
    for (const std::string& name : columns) {
      out.width_m.push_back(positive(table, width, row) * unit);
      out.reading_px.push_back(positive(table, name, row));
    }
  return out;
}

nlohmann::ordered_json scale_json(const RulerReadings& readings, const std::string& name) {
  std::map<double, std::vector<double>> by_width;
  std::vector<double> width_um;
  for (std::size_t i = 0; i < readings.width_m.size(); ++i) {
    // Units are factors that need not be exact in binary: 30 um is 30, not 29.999999999999996.
    width_um.push_back(std::round(readings.width_m[i] * 1e18) / 1e12);
    by_width[width_um.back()].push_back(readings.reading_px[i]);
  }
  if (by_width.size() < 2 || width_um.size() < 3)
    throw Error(
        Errc::input, name,
        fmt::format("has {} of {}; a line through them takes two widths and three readings",
                    width_um.size() == 1 ? "one reading" : fmt::format("{} readings", width_um.size()),
                    by_width.size() == 1 ? "one width" : fmt::format("{} widths", by_width.size())));
  const LineFit line = fit_line(width_um, readings.reading_px);
  const auto slope = line.slope_ci95(), intercept = line.intercept_ci95();
  if (!(slope[0] > 0))
    throw Error(Errc::input, name,
                fmt::format("the readings do not grow with the width beyond doubt (slope {:.3g} px/um, 95 % "
                            "{:.3g} to {:.3g})",
                            line.slope, slope[0], slope[1]));
  Report j;
  j["um_per_px"] = 1 / line.slope;
  j["ci95"] = {1 / slope[1], 1 / slope[0]};
  j["intercept_px"] = line.intercept;
  j["intercept_ci95_px"] = {intercept[0], intercept[1]};
  j["slope_px_per_um"] = line.slope;
  j["slope_ci95_px_per_um"] = {slope[0], slope[1]};
  j["residual_px"] = line.sd;
  j["readings"] = width_um.size();
  std::vector<double> widths, ratios;
  for (const auto& [width, list] : by_width) {
    widths.push_back(width);
    ratios.push_back(width / mean(list));
  }
  j["widths_um"] = widths;
  add_ratios(j, ratios);
  const auto repeat = repeatability(by_width);
  j["repeatability_px"] = repeat ? Report(*repeat) : Report();
  j["edge_excess_px"] = line.intercept;
  j["edge_excess_significant"] = intercept[0] > 0 || intercept[1] < 0;
  j["ratio_bias"] = j["ratio_mean"].get<double>() * line.slope - 1;
  j["spearman"] = spearman(widths, ratios);
  j["spearman_p"] = spearman_p(widths, ratios);
  j["take"] = "regression";
  j["note"] = advice(j);
  return j;
}

nlohmann::ordered_json report_scale_table(const std::filesystem::path& table) {
  Report j = scale_json(read_ruler_table(table), table.string());
  j["method"] = "regression of readings on widths";
  j["source"] = table.string();
  return j;
}

nlohmann::ordered_json report_scale_picture(const std::filesystem::path& picture, double tick_m,
                                            const std::filesystem::path& overlay) {
  const GrayF grey = read_picture(picture).grey;
  RulerOptions options;
  options.name = picture.string();
  const Ruler ruler = find_ruler(grey, options);
  const MarkRow& row = ruler.row;
  const double tick_um = tick_m * 1e6;
  const int used = row.used();
  const double reach = student_t_quantile(0.975, std::max(1, used - 2)) * row.se_pitch_px;
  Report j;
  j["um_per_px"] = tick_um / row.pitch_px;
  j["ci95"] = {tick_um / (row.pitch_px + reach), tick_um / (row.pitch_px - reach)};
  j["tick_um"] = tick_um;
  j["pitch_px"] = row.pitch_px;
  j["pitch_se_px"] = row.se_pitch_px;
  j["residual_px"] = row.residual_px;
  j["marks"] = used;
  j["left_out"] = int(row.marks.size()) - used;
  j["angle_deg"] = ruler.angle_deg;
  j["mark_width_px"] = row.width_px;
  j["mark_length_px"] = row.height_px;
  j["marks_are"] = row.dark ? "dark" : "bright";
  std::vector<double> ratios;
  const RowMark* before = nullptr;
  for (const RowMark& m : row.marks) {
    if (!m.used) continue;
    if (before) ratios.push_back(tick_um * (m.index - before->index) / (m.s - before->s));
    before = &m;
  }
  add_ratios(j, ratios);
  j["image_size"] = {ruler.image_width, ruler.image_height};
  const double share = row.residual_px / row.pitch_px;
  j["quality"] = share < 0.02 && used >= 20 ? "good" : share < 0.05 && used >= 8 ? "fair" : "poor";
  j["take"] = "regression";
  j["note"] =
      "measured from mark to mark, so how wide the marks look plays no part; the interval is that of the "
      "scatter alone: lens distortion and the ruler's own error come on top";
  j["method"] = fmt::format("{} marks of a ruler in a picture, {:g} um apart; quality {}", used, tick_um,
                            j["quality"].get<std::string>());
  j["source"] = picture.string();
  if (!overlay.empty()) write_png(overlay, ruler_overlay(grey, ruler));
  return j;
}

Calibration calibration_of(const nlohmann::ordered_json& report) {
  Calibration c;
  c.um_per_px = report["um_per_px"].get<double>();
  c.ci95 = Vec2{report["ci95"][0].get<double>(), report["ci95"][1].get<double>()};
  c.method = report["method"].get<std::string>();
  c.source = report["source"].get<std::string>();
  return c;
}

}  // namespace faba
