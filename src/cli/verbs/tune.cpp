#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <cmath>

#include "cli/command_line.h"
#include "cli/options/scene.h"
#include "cli/options/study.h"
#include "cli/progress.h"
#include "cli/provenance.h"
#include "core/file.h"
#include "core/toml.h"
#include "study/pages/steering/tuning_report.h"
#include "study/steering/tuning.h"

namespace faba::cli {
namespace {

struct TuneOptions {
  StudyOptions study;
  TuningChoice choice;
  std::vector<std::string> set;
  int evaluations = 40, seeds = 10, held_out = 20;
};

// Option words that make the same study again; see StudySource.
std::vector<std::string> words_of(const TuneOptions& o) {
  std::vector<std::string> words;
  const auto add = [&words](const char* name, const std::string& value) {
    words.insert(words.end(), {name, value});
  };
  for (const std::string& s : o.set) add("--set", s);
  if (!o.choice.controller.empty()) add("--controller", o.choice.controller);
  if (!o.choice.metric.empty()) add("--metric", o.choice.metric);
  for (const std::string& range : o.choice.ranges) add("--range", range);
  add("--evaluations", std::to_string(o.evaluations));
  add("--seeds", std::to_string(o.seeds));
  add("--held-out", std::to_string(o.held_out));
  return words;
}

TuningStudy study_of(const StudySource& source) {
  SceneOptions scene;
  scene.scene = source.file.string();
  TuningChoice choice;
  std::map<std::string, int> count;
  for (std::size_t i = 0; i + 1 < source.options.size(); i += 2) {
    const std::string &name = source.options[i], &value = source.options[i + 1];
    if (name == "--set")
      scene.set.push_back(value);
    else if (name == "--controller")
      choice.controller = value;
    else if (name == "--metric")
      choice.metric = value;
    else if (name == "--range")
      choice.ranges.push_back(value);
    else
      count[name] = std::stoi(value);
  }
  TuningStudy study = new_tuning(read_scene(scene), choice);
  study.evaluations = count.at("--evaluations");
  study.seeds = count.at("--seeds");
  study.held_out_seeds = count.at("--held-out");
  return study;
}

void summary(const Tuning& t) {
  const std::vector<double>& best = t.evaluated[t.best].value;
  for (std::size_t i = 0; i < best.size(); ++i) {
    const TunedParameter& p = t.study.parameters[i];
    fmt::print("{:<20} {}{}\n", p.key, shown_value(p, best[i]),
               p.given ? fmt::format("  (given: {})", shown_value(p, *p.given)) : "");
  }
  fmt::print("{}, held-out seeds: {} tuned, {} given (+- half of the 95 % interval of the mean)\n",
             t.study.metric, tuned_text(t, t.held_out_best.metric, "+-"),
             tuned_text(t, t.held_out_given.metric, "+-"));
}

class TuneJob final : public StudyJob {
 public:
  explicit TuneJob(StudySource source)
      : source_(std::move(source)), study_(study_of(source_)), hash_(study_hash(study_)) {}
  StudySource source() const override { return source_; }
  const std::string& hash() const override { return hash_; }
  std::string report() const override { return "tuning"; }

  bool run(StudyDirectory& dir, SweepOptions options, const Common& c) override {
    Progress bar("trials", !c.quiet && !c.json);
    // The search may end early.
    const auto most = (std::uint64_t(study_.evaluations) + 2) * std::uint64_t(study_.seeds) +
                      2 * std::uint64_t(study_.held_out_seeds);
    options.progress = over_rounds(bar, most);
    result_ = tune(study_, dir.results(), options);
    bar.clear();
    if (!result_) return false;
    const Provenance provenance = study_provenance(source_);
    Json scene = result_->scene;
    write_file(dir.path() / "tuned.toml", to_toml(scene));
    write_file(dir.path() / "report.html", tuning_page(*result_, provenance));
    finish(dir, report(), tuning_json(*result_), provenance, options.threads);
    return true;
  }

  void print(const StudyDirectory& dir, const Common& c) const override {
    if (c.json) print_study(dir, report());
    if (c.json || c.quiet) return;
    for (const std::string& note : tuning_notes(*result_)) print_stderr("faba: note: " + note);
    summary(*result_);
    fmt::print("wrote {} and tuned.toml, the scenario with the tuned controller\n",
               (dir.path() / "report.html").string());
  }

  Round round(const std::filesystem::path&, const std::string& description) const override {
    return tuning_round(study_, description, [&stop = stop_requested()] { return stop.load(); });
  }
  std::vector<std::string> value_names() const override { return {study_.metric}; }

 private:
  StudySource source_;
  TuningStudy study_;
  std::string hash_;
  std::optional<Tuning> result_;
};

int tune_verb(TuneOptions& o, const Common& c) {
  if (o.study.out.empty())
    o.study.out = fmt::format("runs/tune-{}{}{}", o.study.study.stem().string(),
                              o.choice.controller.empty() ? "" : "-", o.choice.controller);
  const SweepOptions options = sweep_options(o.study);  // errors of options come before those of the scenario
  TuneJob job({"tune", o.study.study, {}, words_of(o)});
  return run_study_verb(job, o.study, options, c);
}

}  // namespace

std::unique_ptr<StudyJob> tune_job(const StudySource& source) { return std::make_unique<TuneJob>(source); }

void add_tune(CLI::App& app, CommandLine& line) {
  const auto o = std::make_shared<TuneOptions>();
  CLI::App* v =
      verb(app, line, "tune", "Find the parameters of a scenario's controller that minimise a metric",
           "  faba tune scenes/bench.toml\n"
           "  faba tune scenes/bench.toml --controller lqr --metric settling_time_s\n"
           "  faba tune scenes/bench.toml --range gain=0.1..2 --range \"lead=20 ms..300 ms\" --engine local");
  v->add_option("scene", o->study.study, "Scenario file (TOML), or an example such as bench")
      ->required()
      ->transform(or_example("scenes"));
  v->add_option("--controller", o->choice.controller,
                "Controller to tune, with its default values; default: that of the scenario")
      ->check(not_empty);
  v->add_option("--set", o->set, "Set one value of the scenario: PATH=VALUE")
      ->take_all()
      ->allow_extra_args(false);
  v->add_option("--metric", o->choice.metric,
                "Metric to minimise; default: steady_rms_px for one setpoint, iae_px_s for several")
      ->check(not_empty);
  v->add_option("--range", o->choice.ranges,
                "Parameter with its range, KEY=LOW..HIGH; default: all parameters with a range for tuning")
      ->take_all()
      ->allow_extra_args(false);
  v->add_option("--evaluations", o->evaluations, "Largest number of parameter sets; default: 40")
      ->check(integers(2, 10000));
  v->add_option("--seeds", o->seeds, "Trials of each parameter set; default: 10")->check(integers(2, 10000));
  v->add_option("--held-out", o->held_out,
                "Trials of the comparison with other seeds at the end; default: 20")
      ->check(integers(2, 10000));
  add_study_run_options(v, o->study, "runs/tune-SCENE, or runs/tune-SCENE-CONTROLLER with --controller");
  v->callback([o, &line] { line.code = tune_verb(*o, line.common); });
}

}  // namespace faba::cli
