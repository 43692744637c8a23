#include <fmt/format.h>

#include <CLI/CLI.hpp>

#include "cli/command_line.h"
#include "cli/options/study.h"
#include "cli/progress.h"
#include "cli/provenance.h"
#include "core/file.h"
#include "core/toml.h"
#include "study/pages/steering/control_benchmark_report.h"
#include "study/quality/rounded.h"
#include "study/steering/metric_list.h"

namespace faba::cli {
namespace {

struct BenchmarkOptions {
  StudyOptions study;
  std::vector<std::string> only;
};

std::vector<std::string> only_of(const StudySource& source) {
  std::vector<std::string> only;
  for (std::size_t i = 0; i + 1 < source.options.size(); i += 2) only.push_back(source.options[i + 1]);
  return only;
}

// One line for each case: the best controller.
void summary(const ControlBenchmarkResult& r) {
  for (std::size_t i = 0; i < r.cases.size(); ++i) {
    const BenchmarkCase& one = r.benchmark.cases[i];
    const MetricInfo& m = metric(one.study.ranked_by);
    for (const Combination& c : r.cases[i].combinations) {
      const auto it = c.metrics.find(m.key);
      if (c.excess_over_best || it == c.metrics.end()) continue;
      const auto inside = c.metrics.find("keep_out_fraction");
      fmt::print(
          "{:<24} delay {}: {} {} {}, {}{}\n", one.name, c.delay,
          with_uncertainty(m.shown * it->second.mean, m.shown * (it->second.mean - it->second.ci95[0])),
          m.unit, m.name, c.controller,
          inside != c.metrics.end() && inside->second.mean > 0
              ? fmt::format("; its mean was in a forbidden region in {:.3g} % of the frames",
                            100 * inside->second.mean)
              : "");
    }
  }
}

class ControlBenchmarkJob final : public StudyJob {
 public:
  explicit ControlBenchmarkJob(StudySource source)
      : source_(std::move(source)),
        benchmark_(read_control_benchmark(source_.file, only_of(source_))),
        hash_(study_hash(benchmark_)) {}
  StudySource source() const override { return source_; }
  const std::string& hash() const override { return hash_; }
  std::string report() const override { return "benchmark"; }

  bool run(StudyDirectory& dir, SweepOptions options, const Common& c) override {
    Progress bar("trials", !c.quiet && !c.json);
    std::uint64_t all = 0;
    for (const BenchmarkCase& one : benchmark_.cases)
      all += one.study.controllers.size() * std::max<std::size_t>(1, one.study.delays.size()) *
             std::size_t(one.study.seeds);
    options.progress = over_rounds(bar, all);
    result_ = run_control_benchmark(benchmark_, dir.results(), options);
    bar.clear();
    if (!result_) return false;
    const std::vector<CycleTime> cycles = measured_cycle_times(benchmark_, options.stop);
    const Provenance provenance = study_provenance(source_);
    write_file(dir.path() / "control.md", control_benchmark_markdown(*result_, cycles));
    write_file(dir.path() / "cycles.csv", cycle_times_csv(cycles));
    write_file(dir.path() / "report.html", control_benchmark_page(*result_, cycles, provenance));
    finish(dir, report(), control_benchmark_json(*result_), provenance, options.threads);
    return true;
  }

  void print(const StudyDirectory& dir, const Common& c) const override {
    if (c.json) print_study(dir, report());
    if (!c.quiet)
      for (const ControllerComparison& one : result_->cases)
        for (const std::string& note : one.notes)
          print_stderr(fmt::format("faba: note: {}: {}", one.study.title, note));
    if (c.json || c.quiet) return;
    summary(*result_);
    fmt::print("wrote {} and control.md\n", (dir.path() / "report.html").string());
  }

  Round round(const std::filesystem::path&, const std::string& description) const override {
    return control_benchmark_round(benchmark_, description,
                                   [&stop = stop_requested()] { return stop.load(); });
  }
  std::vector<std::string> value_names() const override { return trial_value_names(); }

 private:
  StudySource source_;
  ControlBenchmark benchmark_;
  std::string hash_;
  std::optional<ControlBenchmarkResult> result_;
};

int benchmark_verb(const BenchmarkOptions& o, const Common& c) {
  const SweepOptions options =
      sweep_options(o.study);  // errors of options come before those of the benchmark
  StudySource source{"benchmark-control", o.study.study, {}, {}};
  for (const std::string& name : o.only) source.options.insert(source.options.end(), {"--only", name});
  ControlBenchmarkJob job(std::move(source));
  return run_study_verb(job, o.study, options, c);
}

}  // namespace

std::unique_ptr<StudyJob> control_benchmark_job(const StudySource& source) {
  return std::make_unique<ControlBenchmarkJob>(source);
}

void add_benchmark_control(CLI::App& app, CommandLine& line) {
  const auto o = std::make_shared<BenchmarkOptions>();
  o->study.study = "studies/control-benchmark.toml";
  CLI::App* v = verb(app, line, "benchmark-control",
                     "Compare controllers in a fixed set of cases, with published results beside them",
                     "  faba benchmark-control\n"
                     "  faba benchmark-control --only hold --only route\n"
                     "  faba benchmark-control mine.toml --engine slurm");
  v->add_option("benchmark", o->study.study,
                "Benchmark file (TOML); default: studies/control-benchmark.toml");
  v->add_option("--only", o->only, "Only this case; can be repeated")->take_all()->allow_extra_args(false);
  add_study_run_options(v, o->study, "runs/NAME");
  v->callback([o, &line] { line.code = benchmark_verb(*o, line.common); });
}

}  // namespace faba::cli
