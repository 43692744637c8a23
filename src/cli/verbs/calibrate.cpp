#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <cmath>

#include "cli/command_line.h"
#include "cli/options/study.h"
#include "cli/progress.h"
#include "cli/provenance.h"
#include "cli/quality_text.h"
#include "core/counted.h"
#include "core/error.h"
#include "core/file.h"
#include "study/calibrate/calibration.h"
#include "study/pages/calibration/calibration_report.h"

namespace faba::cli {
namespace {

void print_coverage(const ModelCalibration& m) {
  fmt::print("{}: {}\n  {:<28} {:>15} {:>15} {:>15} {:>15}  {:>9}  {:>14}\n", m.name,
             counted(std::uint64_t(m.experiments), "experiment"), "coverage of the intervals of", "50 %",
             "80 %", "90 %", "95 %", "ranks p", "bias/sd");
  for (const ParameterCalibration& p : m.parameters) {
    fmt::print("  {:<28}", p.parameter.path);
    for (const Coverage& c : p.coverage)
      fmt::print(" {:>15}", fmt::format("{:.1f} %{}", 100 * c.fraction(), c.within() ? "" : " (outside)"));
    const std::string error = std::isfinite(p.bias_se) ? fmt::format(" +- {:.2f}", p.bias_se) : "";
    fmt::print("  {:>9.2g}  {:>14}\n", p.ranks.p, fmt::format("{:+.2f}{}", p.bias, error));
  }
  if (!m.parameters.empty())
    fmt::print("  all parameters together (TARP): largest difference {:.3f}, p = {:.2g}\n", m.tarp.largest,
               m.tarp.p);
}

void print_selection(const StudyCalibration& c) {
  if (c.study.design.candidates.size() < 2 && c.kinds.size() < 2) return;
  std::size_t width = 11;
  for (const SelectionCalibration& s : c.kinds) width = std::max(width, s.kind.size());
  fmt::print("{:<{}}  {:>9}  {:>9}  {:>11}  {:>11}  {:>22}\n", "experiments", width, "best true", "clear",
             "clear wrong", "false clear", "95 % interval of it");
  for (const SelectionCalibration& s : c.kinds) {
    const auto text = [](const ExperimentCount& n) {
      return n.of > 0 ? fmt::format("{}/{}", n.count, n.of) : "-";
    };
    const ExperimentCount& clear = s.false_clear;
    fmt::print(
        "{:<{}}  {:>9}  {:>9}  {:>11}  {:>11}  {:>22}\n", s.kind, width, text(s.best_is_true), text(s.clear),
        text(s.wrong_clear), text(clear),
        clear.of > 0 ? fmt::format("{:.1f} to {:.1f} %", 100 * clear.ci95[0], 100 * clear.ci95[1]) : "-");
  }
}

class CalibrateJob final : public StudyJob {
 public:
  CalibrateJob(StudySource source, bool needs_videos)
      : source_(std::move(source)), study_(read_calibration_study(source_.file, needs_videos)) {
    std::vector<ResponseInput>& videos = study_.design.videos;
    if (needs_videos) {
      digest_videos(study_.design);
      source_.inputs.clear();
      for (const ResponseInput& video : videos) source_.inputs.push_back(video.digest);
    } else {
      take_digests(study_.design, source_.inputs);
    }
    hash_ = study_hash(study_);
  }
  StudySource source() const override { return source_; }
  const std::string& hash() const override { return hash_; }
  std::string report() const override { return "calibration"; }

  bool run(StudyDirectory& dir, SweepOptions options, const Common& c) override {
    Progress bar("experiments", !c.quiet && !c.json), reader("reading frames", !c.quiet && !c.json);
    std::uint64_t frames = 0;
    options.progress = [&](std::uint64_t done, std::uint64_t total) {
      reader.clear();
      bar.update(done, total);
    };
    result_ = calibrate(study_, dir.results(), options, [&] { reader.update(++frames, 0); });
    reader.clear();
    bar.clear();
    if (!result_) return false;
    Provenance provenance;
    provenance.add(source_.file);
    for (const ResponseInput& video : study_.design.videos) provenance.add(video.file);
    write_file(dir.path() / "calibration.html", calibration_page(*result_, provenance));
    finish(dir, report(), calibration_json(*result_), provenance, options.threads);
    return true;
  }

  void print(const StudyDirectory& dir, const Common& c) const override {
    if (c.json) print_study(dir, report());
    if (c.json || c.quiet) return;
    for (const ModelCalibration& m : result_->models) print_coverage(m);
    print_selection(*result_);
    print_quality(calibration_warnings(*result_));
    fmt::print("wrote {}\n", (dir.path() / "calibration.html").string());
  }

  Round round(const std::filesystem::path& measured, const std::string&) const override {
    return calibration_round(study_, measured, [&stop = stop_requested()] { return stop.load(); });
  }
  std::vector<std::string> value_names() const override { return CalibrationRecord::names(); }

 private:
  StudySource source_;
  CalibrationStudy study_;
  std::string hash_;
  std::optional<StudyCalibration> result_;
};

int calibrate_verb(const StudyOptions& v, const Common& c) {
  const SweepOptions options = sweep_options(v);  // errors of options come before those of the study
  CalibrateJob job({"calibrate", v.study, {}, {}}, true);
  return run_study_verb(job, v, options, c);
}

}  // namespace

std::unique_ptr<StudyJob> calibrate_job(const StudySource& source, bool needs_inputs) {
  return std::make_unique<CalibrateJob>(source, needs_inputs);
}

void add_calibrate(CLI::App& app, CommandLine& line) {
  const auto o = std::make_shared<StudyOptions>();
  CLI::App* v = verb(app, line, "calibrate",
                     "Test whether the intervals of identify contain the truth as often as they state",
                     "  faba calibrate studies/calibrate-dipole.toml\n"
                     "  faba calibrate study.toml --threads 2\n"
                     "  faba calibrate study.toml --engine slurm --engine-set partition=short");
  add_study_options(v, *o);
  v->callback([o, &line] { line.code = calibrate_verb(*o, line.common); });
}

}  // namespace faba::cli
