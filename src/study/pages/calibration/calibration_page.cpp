#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "core/counted.h"
#include "study/pages/calibration/calibration_figures.h"
#include "study/pages/calibration/calibration_report.h"
#include "study/pages/provenance_output.h"
#include "study/pages/quality_output.h"
#include "study/plot/markup.h"
#include "study/plot/report_page.h"

namespace faba {
namespace {

std::string percent(double fraction) { return fmt::format("{:.1f} %", 100 * fraction); }

std::string verdict(const Coverage& c) {
  const std::string range = fmt::format("right intervals contain it in {} to {} (99 %)", c.low, c.high);
  if (!c.within())
    return fmt::format("The intervals are too {}: {}.", c.inside < c.low ? "narrow" : "wide", range);
  return c.tells() ? fmt::format("This agrees with right intervals: {}.", range)
                   : fmt::format("These are too few experiments for a test: {}.", range);
}

std::string calibration_lead(const StudyCalibration& c) {
  std::string out;
  for (const ModelCalibration& m : c.models) {
    if (m.parameters.empty()) continue;
    const ParameterCalibration& p = m.parameters.front();
    const Coverage& main =
        *std::ranges::find_if(p.coverage, [](const Coverage& o) { return o.level == 0.9; });
    out += fmt::format(
        "<p class=\"lead\">{}: the 90 % interval of {} contains the true value in {} of {} experiments ({}). "
        "{}</p>\n",
        escape_markup(m.name), escape_markup(p.parameter.path), main.inside, main.experiments,
        percent(main.fraction()), verdict(main));
  }
  if (out.empty()) return out;
  return out + fmt::format(
                   "<p class=\"note\">This is an average over the prior ranges, for simulated cells. {}"
                   "</p>\n",
                   c.study.design.look == Look::video
                       ? "The experiments were rendered to videos and measured."
                       : "The statistics follow from the positions of the cells: the method is "
                         "tested, the measurement of videos is not.");
}

// Coverage with a mark outside of the 99 % range.
std::string coverage_cell(const Coverage& c) {
  return fmt::format("{}{}<small>{} to {}</small>", percent(c.fraction()), c.within() ? "" : " (outside)",
                     percent(double(c.low) / c.experiments), percent(double(c.high) / c.experiments));
}

std::string coverage_row(const ModelCalibration& m, const ParameterCalibration& p) {
  std::vector<std::string> cells{escape_markup(
      fmt::format("{}: {}{}", m.name, p.parameter.path, p.parameter.nuisance() ? " (nuisance)" : ""))};
  for (const Coverage& c : p.coverage) cells.push_back(coverage_cell(c));
  cells.push_back(
      fmt::format("{} of {}<small>p = {:.2g}</small>", p.ranks.outside(), p.ranks.counts.size(), p.ranks.p));
  cells.push_back(std::isfinite(p.spread)
                      ? fmt::format("{:+.2f} ± {:.2f}<small>s.d. {:.2f}</small>", p.bias, p.bias_se, p.spread)
                      : fmt::format("{:+.2f}", p.bias));
  cells.push_back(std::isfinite(p.relative_bias) ? fmt::format("{:+.1f} %<small>error {:.1f} %</small>",
                                                               100 * p.relative_bias, 100 * p.relative_error)
                                                 : "–");
  cells.push_back(percent(p.fraction_of_range));
  return table_row(cells, "td");
}

std::string coverage_table(const StudyCalibration& c) {
  if (c.models.empty()) return "";
  std::string out = "<h2>Intervals</h2>\n<div class=\"wide\"><table class=\"numbers\">\n<thead>" +
                    table_row({"parameter", "50 %", "80 %", "90 %", "95 %", "rank bins outside",
                               "bias (posterior s.d.)", "relative bias", "90 % interval over prior range"},
                              "th") +
                    "</thead><tbody>\n";
  for (const ModelCalibration& m : c.models)
    for (const ParameterCalibration& p : m.parameters) out += coverage_row(m, p);
  return out +
         "</tbody></table></div>\n<p class=\"note\">Coverage: fraction of the experiments whose central "
         "posterior interval contains the true value; below it the range for calibrated intervals "
         "(binomial, 99 %). Rank bins outside: number of bins of the rank histogram outside of its 99 % "
         "band, "
         "and p of the chi-square test of flatness. Bias: mean over the experiments of posterior mean minus "
         "truth, in units of the standard deviation of the posterior, with standard error; the standard "
         "deviation of this quantity is 1 for calibrated normal posteriors. Relative bias: median of "
         "posterior "
         "median over truth, minus 1; error: median of its absolute value. The last column is the median "
         "width of the intervals.</p>\n";
}

std::string count_cell(const ExperimentCount& n) {
  if (n.of == 0) return "–";
  return fmt::format("{} of {}<small>{} to {}</small>", n.count, n.of, percent(n.ci95[0]),
                     percent(n.ci95[1]));
}

std::string selection_table(const StudyCalibration& c) {
  const bool several = c.study.design.candidates.size() > 1;
  if (!several && c.kinds.size() < 2) return "";
  std::string out = "<h2>Model selection</h2>\n<div class=\"wide\"><table class=\"numbers\">\n<thead>" +
                    table_row({"experiments", "best is true model", "clear", "clear for a wrong model",
                               "false clear", "false clear, difference not named", "difference named",
                               "with warnings", "90 % interval contains the truth"},
                              "th") +
                    "</thead><tbody>\n";
  for (const SelectionCalibration& s : c.kinds)
    out += table_row({escape_markup(s.kind), count_cell(s.best_is_true), count_cell(s.clear),
                      count_cell(s.wrong_clear), count_cell(s.false_clear), count_cell(s.false_clear_unnamed),
                      s.misspecified ? count_cell(s.named) : "–", count_cell(s.warned), count_cell(s.inside)},
                     "td");
  return out +
         "</tbody></table></div>\n<p class=\"note\">Below each count: 95 % interval of the fraction (Clopper "
         "and Pearson). False clear: clear evidence for a wrong model, or clear evidence although the 90 % "
         "interval of the first parameter of the true model does not contain the truth. Difference named: a "
         "warning has an aspect that the calibration file gives for this kind.</p>\n";
}

std::string calibration_notes(const StudyCalibration& c) {
  std::string out =
      fmt::format("<li>Design: {}, {} simulations per model and video, {}. Seed {}.</li>\n",
                  escape_markup(c.study.designed_by), c.study.design.simulations,
                  c.study.design.look == Look::video
                      ? "experiments rendered to videos, which are measured like those of a study"
                      : "experiments observed as positions of the cells",
                  c.study.seed);
  for (const SelectionCalibration& s : c.kinds)
    if (s.failed > 0 || s.sampled_again > 0)
      out += fmt::format(
          "<li>{}: {} could not be identified; {} parameters were replaced because their experiment could "
          "not be measured, for example without cells in view.</li>\n",
          escape_markup(s.kind), counted(std::uint64_t(s.failed), "experiment"), s.sampled_again);
  return "<h2>Notes</h2>\n<ul>\n" + out + "</ul>\n";
}

}  // namespace

std::string calibration_page(const StudyCalibration& c, const Provenance& provenance) {
  std::string out = fmt::format("<h1>{}</h1>\n", escape_markup(c.study.title)) + calibration_lead(c) +
                    quality_markup(calibration_warnings(c)) + coverage_table(c) + selection_table(c);
  int number = 0;
  for (const ModelCalibration& m : c.models) {
    if (m.parameters.empty()) continue;
    std::vector<Figure> figures{coverage_figure(m), tarp_figure(m)};
    for (const ParameterCalibration& p : m.parameters) {
      figures.push_back(rank_figure(m, p));
      figures.push_back(truth_figure(m, p));
    }
    out += fmt::format("<h2>{}: {}</h2>\n<div class=\"figures\">\n", escape_markup(m.name),
                       counted(std::uint64_t(m.experiments), "experiment")) +
           figures_markup(figures, number) + "</div>\n";
  }
  return html_page(c.study.title, out + calibration_notes(c) + provenance_markup(provenance));
}

}  // namespace faba
