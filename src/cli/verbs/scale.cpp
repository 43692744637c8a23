#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <nlohmann/json.hpp>
#include <stdexcept>

#include "cli/command_line.h"
#include "cli/output_file.h"
#include "cli/provenance.h"
#include "cli/quality_text.h"
#include "cli/quantity.h"
#include "core/error.h"
#include "study/pages/scale_report.h"
#include "study/quality/rounded.h"

namespace faba::cli {
namespace {

struct ScaleVerb {
  std::filesystem::path ruler, out, overlay;
  std::string tick;
  bool force = false;
};

double tick_of(const std::string& text) {
  if (text.empty())
    throw Error(Errc::usage, "--tick",
                "option is missing; give the distance between neighbouring marks of the finest division, "
                "such as --tick \"10 um\"");
  const double tick = quantity_of(text, "m", "--tick", "10 um");
  if (!(tick >= 1e-9 && tick <= 1))
    throw Error(
        Errc::usage, "--tick",
        fmt::format("\"{}\" is out of range; it must be between 1 nm and 1 m, such as \"10 um\"", text));
  return tick;
}

void print_regression(double um_per_px, const std::array<double, 2>& ci95) {
  const RoundedInterval text = rounded_interval(um_per_px, ci95);
  fmt::print("regression   {} um/px, 95 % interval {} to {}\n", text.value, text.low, text.high);
}

void print_table(const TableScale& s) {
  fmt::print("  width um   um per px\n");
  for (std::size_t i = 0; i < s.ratios.each.size(); ++i)
    fmt::print("{:10g}   {:9.6f}\n", s.widths_um[i], s.ratios.each[i]);
  fmt::print(
      "mean ratio   {:.6f} um/px, s.d. {:.6f}, s.e.m. {:.4f}; trend with width (Spearman) {:.2f}, p {:.3f}\n",
      s.ratios.mean, s.ratios.sd, s.ratios.sem, s.spearman, s.spearman_p);
  print_regression(s.um_per_px, s.ci95);
  fmt::print("             reading = {:.2f} px (95 % interval {:.1f} to {:.1f} px) + {:.4f} px/um x width",
             s.intercept_px, s.intercept_ci95_px[0], s.intercept_ci95_px[1], s.slope_px_per_um);
  if (s.repeatability_px) fmt::print("; repeatability {:.2f} px", *s.repeatability_px);
  fmt::print("\n");
}

void print_picture(const PictureScale& s) {
  fmt::print(
      "marks        {} {}, spacing {:.4f} px (s.e. {:.4f}), angle {:.2f} degrees counter-clockwise from x, "
      "scatter "
      "{:.2f} px\n",
      s.marks, s.dark ? "dark" : "bright", s.pitch_px, s.pitch_se_px, -s.angle_deg, s.residual_px);
  fmt::print("mean ratio   {:.5f} um/px, s.d. {:.5f}, s.e.m. {:.5f}\n", s.ratios.mean, s.ratios.sd,
             s.ratios.sem);
  print_regression(s.um_per_px, s.ci95);
}

template <class Scale, class Print>
void print_scale(const Scale& s, const ScaleVerb& v, const Common& c, Print&& print) {
  if (!v.out.empty()) write_calibration(v.out, calibration_of(s));
  if (c.json) {
    print_json(scale_json(s), provenance_of(c, {v.ruler}));
    return;
  }
  if (c.quiet) return;
  print(s);
  fmt::print("note         {}\n", scale_note(s));
  print_quality(s.warnings, 13);
  if (!v.overlay.empty()) fmt::print("overlay      {}\n", v.overlay.string());
  if (!v.out.empty())
    fmt::print("calibration  {}; in a scenario: [scale] file = \"{}\"\n", v.out.string(), v.out.string());
}

void scale_of_picture(const ScaleVerb& v, const Common& c) {
  const PictureScale s = report_scale_picture(v.ruler, tick_of(v.tick), v.overlay);
  if (!v.out.empty() && !v.force && quality_of(s.warnings) == Quality::poor)
    throw Error(
        Errc::input, v.ruler.string(),
        fmt::format("the detected marks are too few or too irregular for a calibration ({} marks, scatter "
                    "{:.2f} px); check them with --overlay, or write {} anyway with --force",
                    s.marks, s.residual_px, v.out.string()));
  print_scale(s, v, c, print_picture);
}

int scale(const ScaleVerb& v, const Common& c) {
  check_output(v.out, {".toml"}, v.force, {v.ruler});
  check_output(v.overlay, {".png"}, v.force, {v.ruler});
  const bool table = is_ruler_table(v.ruler);
  if (table && !v.tick.empty())
    throw Error(Errc::usage, "--tick", "requires a picture; a table has the widths");
  if (table && !v.overlay.empty())
    throw Error(Errc::usage, "--overlay", "requires a picture, but a table is given");
  if (!table) {
    if (v.tick.empty()) check_ruler_picture(v.ruler);  // --tick does not help with any other file
    scale_of_picture(v, c);
    return 0;
  }
  const TableScale s = measure_scale(read_ruler_table(v.ruler), v.ruler.string());
  print_scale(s, v, c, print_table);
  return 0;
}

}  // namespace

void add_scale(CLI::App& app, CommandLine& line) {
  const auto s = std::make_shared<ScaleVerb>();
  CLI::App* v =
      verb(app, line, "scale", "Determine micrometres per pixel, from a table or a picture of a ruler",
           "  faba scale readings.csv --out calibration.toml\n"
           "  faba scale ruler.png --tick \"10 um\" --overlay marks.png");
  v->add_option("ruler", s->ruler, "Readings as CSV (width_um,px_1,px_2), or a picture of a ruler")
      ->required();
  v->add_option("--tick", s->tick,
                "Picture: distance between neighbouring marks of the finest division, such as \"10 um\"")
      ->check(not_empty);
  v->add_option("--out", s->out, "Write a calibration file for scenarios and analyses, as TOML")
      ->check(not_empty);
  v->add_option("--overlay", s->overlay, "Write the picture with the detected marks, as PNG")
      ->check(not_empty);
  v->add_flag("--force", s->force, "Replace existing files");
  v->callback([s, &line] { line.code = scale(*s, line.common); });
}

}  // namespace faba::cli
