#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <algorithm>
#include <cmath>

#include "cli/command_line.h"
#include "cli/options/study.h"
#include "cli/progress.h"
#include "cli/provenance.h"
#include "core/counted.h"
#include "core/file.h"
#include "core/toml.h"
#include "study/pages/steering/controller_report.h"
#include "study/quality/rounded.h"
#include "study/steering/controller_study.h"

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

class ControllersJob final : public StudyJob {
 public:
  explicit ControllersJob(StudySource source)
      : source_(std::move(source)), study_(read_controller_study(source_.file)), hash_(study_hash(study_)) {}
  StudySource source() const override { return source_; }
  const std::string& hash() const override { return hash_; }
  std::string report() const override { return "controllers"; }

  bool run(StudyDirectory& dir, SweepOptions options, const Common& c) override {
    Progress bar("trials", !c.quiet && !c.json);
    options.progress = [&bar](std::uint64_t done, std::uint64_t total) { bar.update(done, total); };
    result_ = compare_controllers(study_, dir.results(), options);
    bar.clear();
    if (!result_) return false;
    Provenance provenance;
    provenance.add(source_.file);
    provenance.add(study_.scene.name);
    write_file(dir.path() / "controllers.csv", controllers_csv(*result_));
    if (const Json best = best_scene(*result_); !best.is_null())
      write_file(dir.path() / "best.toml", to_toml(best));
    write_file(dir.path() / "report.html", controllers_page(*result_, provenance));
    finish(dir, report(), controllers_json(*result_), provenance, options.threads);
    return true;
  }

  void print(const StudyDirectory& dir, const Common& c) const override {
    if (c.json) print_study(dir, report());
    if (!c.quiet)
      for (const std::string& note : result_->notes) print_stderr("faba: note: " + note);
    if (c.json || c.quiet) return;
    summary(*result_);
    fmt::print("wrote {}\n", (dir.path() / "report.html").string());
  }

  Round round(const std::filesystem::path&, const std::string&) const override {
    return controller_trials(study_, [&stop = stop_requested()] { return stop.load(); });
  }
  std::vector<std::string> value_names() const override { return trial_value_names(); }

 private:
  StudySource source_;
  ControllerStudy study_;
  std::string hash_;
  std::optional<ControllerComparison> result_;
};

int compare_controllers_verb(const StudyOptions& v, const Common& c) {
  const SweepOptions options = sweep_options(v);  // errors of options come before those of the study
  ControllersJob job({"compare-controllers", v.study, {}, {}});
  return run_study_verb(job, v, options, c);
}

}  // namespace

std::unique_ptr<StudyJob> controllers_job(const StudySource& source) {
  return std::make_unique<ControllersJob>(source);
}

void add_compare_controllers(CLI::App& app, CommandLine& line) {
  const auto o = std::make_shared<StudyOptions>();
  CLI::App* v = verb(app, line, "compare-controllers",
                     "Compare controllers with several models and delays, each over many seeds",
                     "  faba compare-controllers studies/controllers.toml\n"
                     "  faba compare-controllers study.toml --out runs/mine --threads 1\n"
                     "  faba compare-controllers study.toml --engine local");
  add_study_options(v, *o);
  v->callback([o, &line] { line.code = compare_controllers_verb(*o, line.common); });
}

}  // namespace faba::cli
