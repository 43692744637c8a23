#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <algorithm>
#include <cmath>

#include "cli/command_line.h"
#include "cli/options/study.h"
#include "cli/provenance.h"
#include "core/counted.h"
#include "core/file.h"
#include "study/pages/controller_report.h"
#include "study/quality/rounded.h"

namespace faba::cli {
namespace {

void summary(const ControllerComparison& r) {
  std::size_t controller = 10, model = 5;  // widths of the columns
  for (const Combination& combination : r.combinations) {
    controller = std::max(controller, combination.controller.size());
    model = std::max(model, combination.model.size());
  }
  fmt::print("{:<{}}  {:<{}}  {:>13}  {:>8}  {:>17}  {:>21}  {:>17}\n", "controller", controller, "model",
             model, "delay, frames", "settled", "settling time s", "steady-state error px", "dispersion px");
  const auto mean_text = [](const Combination& combination, const char* name) {
    const auto it = combination.metrics.find(name);
    if (it == combination.metrics.end()) return std::string("-");
    const double half_width = it->second.mean - it->second.ci95[0];
    return std::isfinite(half_width) ? with_uncertainty(it->second.mean, half_width)
                                     : fmt::format("{:.3g} (one trial)", it->second.mean);
  };
  for (const Combination& combination : r.combinations)
    fmt::print("{:<{}}  {:<{}}  {:>13}  {:>8}  {:>17}  {:>21}  {:>17}\n", combination.controller, controller,
               combination.model, model, combination.delay,
               fmt::format("{}/{}", combination.settled, combination.trials),
               mean_text(combination, "settling_time_s"), mean_text(combination, "steady_rms_px"),
               mean_text(combination, "rms_radius_px"));
  fmt::print("means over {} +- half width of the 95 % interval; settling times: only trials that settled\n",
             counted(std::uint64_t(r.study.seeds), "seed"));
}

int compare_controllers(const StudyOptions& v, const Common& c) {
  Progress bar("trials", !c.quiet && !c.json);
  const SweepOptions options = sweep_options(v, bar);  // errors of options come before those of the study
  const ControllerStudy study = read_controller_study(v.study);
  const std::string hash = study_hash(study);
  if (report_if_complete(v, "controllers", hash, c)) return 0;
  StudyDirectory dir = open_study(v, "compare-controllers", hash);
  const auto result = compare_controllers(study, dir.results(), options);
  bar.clear();
  if (!result) return report_partial(v, c, dir);
  const Provenance provenance = provenance_of(c, {v.study, study.scene.name});
  write_file(dir.path() / "controllers.csv", controllers_csv(*result));
  write_file(dir.path() / "report.html", controllers_page(*result, provenance));
  finish(dir, "controllers", controllers_json(*result), provenance, v);
  if (c.json) print_study(dir, "controllers");
  if (!c.quiet)
    for (const std::string& note : result->notes) print_stderr("faba: note: " + note);
  if (!c.json && !c.quiet) {
    summary(*result);
    fmt::print("wrote {}\n", (dir.path() / "report.html").string());
  }
  return 0;
}

}  // namespace

void add_compare_controllers(CLI::App& app, CommandLine& line) {
  const auto o = std::make_shared<StudyOptions>();
  CLI::App* v = verb(app, line, "compare-controllers",
                     "Compare controllers with several models and delays, each over many seeds",
                     "  faba compare-controllers studies/controllers.toml\n"
                     "  faba compare-controllers study.toml --out runs/mine --threads 1");
  add_study_options(v, *o);
  v->callback([o, &line] { line.code = compare_controllers(*o, line.common); });
}

}  // namespace faba::cli
