#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <algorithm>

#include "cli/command_line.h"
#include "cli/options/study.h"
#include "cli/options/video_part.h"
#include "cli/progress.h"
#include "cli/provenance.h"
#include "cli/quality_text.h"
#include "core/error.h"
#include "core/file.h"
#include "study/identify/best_scene.h"
#include "study/identify/identify.h"
#include "study/identify/identify_warnings.h"
#include "study/identify/response/measured_response.h"
#include "study/pages/identify_report.h"
#include "study/quality/rounded.h"

namespace faba::cli {
namespace {

// `abc`: name of the second method.
void print_parameter(const FoundParameter& p, const char* abc) {
  const FreeParameter& q = p.parameter;
  const auto text = [&](double median, const std::array<double, 2>& ci90) {
    return rounded_interval(q.shown(median), {q.shown(ci90[0]), q.shown(ci90[1])});
  };
  const RoundedInterval found = text(p.median, p.ci90), second = text(p.abc_median, p.abc_ci90);
  fmt::print("  {:<28} {} {}  90 % interval {} to {}   ({} {}, {} to {})\n", q.path, found.value,
             q.shown_unit(), found.low, found.high, abc, second.value, second.low, second.high);
  if (!p.doubt.empty() && !q.nuisance()) fmt::print("    {}\n", p.doubt);
}

void summary(const Identification& r) {
  const char* abc = "approximate Bayesian computation, ABC:";  // in full on first use
  for (const FoundModel& m : r.models) {
    if (!m.failed.empty()) {
      fmt::print("{}: {}\n", m.name, m.failed);
      continue;
    }
    fmt::print(
        "{}: energy score {:.3f} (lower is better), goodness-of-fit p {:.2g}, {} valid simulations in {} "
        "rounds\n",
        m.name, m.score, m.fit_p, m.simulations, m.rounds);
    if (m.fit_p < FoundModel::kPoorFit)
      fmt::print("  {} does not explain the videos (fit p = {:.2g}): do not use its intervals\n", m.name,
                 m.fit_p);
    for (const bool nuisance : {false, true}) {
      const auto of_kind = [&](const FoundParameter& p) { return p.parameter.nuisance() == nuisance; };
      if (nuisance && std::any_of(m.parameters.begin(), m.parameters.end(), of_kind))
        fmt::print("  nuisance parameters, free by default:\n");
      for (const FoundParameter& p : m.parameters) {
        if (!of_kind(p)) continue;
        print_parameter(p, abc);
        abc = "ABC";
      }
    }
  }
  for (const LegacyModel& m : r.legacy)
    fmt::print("legacy rule (unreliable): {}: {}\n", m.name,
               m.invalid_reason.empty() ? fmt::format("the slope is zero at {:.4g} {}",
                                                      m.parameter.shown(m.zero), m.parameter.shown_unit())
                                        : "no result, because " + m.invalid_reason);
  fmt::print("{}\n", r.words);
}

struct IdentifyOptions {
  StudyOptions study;
  PartOptions part;
};

// --from and --to are for the videos that have no part of their own in the study.
void select_part(IdentifyStudy& study, const VideoPart& part) {
  if (!(part.from_s > 0) && !part.to_s) return;
  for (ResponseInput& video : study.videos)
    if (!(video.part.from_s > 0) && !video.part.to_s) video.part = {part.from_s, part.to_s, video.part.fps};
}

PartOptions part_of(const StudySource& source) {
  PartOptions part;
  for (std::size_t i = 0; i + 1 < source.options.size(); i += 2)
    (source.options[i] == "--from" ? part.from : part.to) = std::stod(source.options[i + 1]);
  return part;
}

class IdentifyJob final : public StudyJob {
 public:
  IdentifyJob(StudySource source, bool needs_videos)
      : source_(std::move(source)), study_(read_identify_study(source_.file, needs_videos)) {
    select_part(study_, part_of(source_).part());
    if (needs_videos)
      digest_videos(study_);
    else
      take_digests(study_, source_.inputs);
    source_.inputs.clear();
    for (const ResponseInput& video : study_.videos) source_.inputs.push_back(video.digest);
    hash_ = study_hash(study_);
  }
  StudySource source() const override { return source_; }
  const std::string& hash() const override { return hash_; }
  std::string report() const override { return "identify"; }

  bool run(StudyDirectory& dir, SweepOptions options, const Common& c) override {
    Progress bar("simulating", !c.quiet && !c.json), reader("reading frames", !c.quiet && !c.json);
    std::uint64_t frames = 0;
    options.progress = [&](std::uint64_t done, std::uint64_t total) {
      reader.clear();
      bar.update(done, total);
    };
    result_ = identify(study_, dir.results(), options, [&] { reader.update(++frames, 0); });
    reader.clear();
    bar.clear();
    if (!result_) return false;
    write_best_scene(*result_, dir.path());
    Provenance provenance = study_provenance(source_);
    for (const ResponseInput& video : study_.videos) provenance.add(video.file);
    write_file(dir.path() / "identify.html", identify_page(*result_, provenance));
    finish(dir, report(), identify_json(*result_), provenance, options.threads);
    return true;
  }

  void print(const StudyDirectory& dir, const Common& c) const override {
    if (c.json) print_study(dir, report());
    if (c.json || c.quiet) return;
    for (const std::string& note : notes_of(*result_)) print_stderr("faba: note: " + note);
    summary(*result_);
    print_quality(identify_warnings(*result_));
    fmt::print("wrote {} and best.toml, the scenario of the best model\n",
               (dir.path() / "identify.html").string());
  }

  Round round(const std::filesystem::path& measured, const std::string& description) const override {
    return planned_simulations(study_, measured, description);
  }

 private:
  StudySource source_;
  IdentifyStudy study_;
  std::string hash_;
  std::optional<Identification> result_;
};

int identify_verb(const IdentifyOptions& o, const Common& c) {
  const SweepOptions options = sweep_options(o.study);  // errors of options come before those of the study
  (void)o.part.part();
  StudySource source{"identify", o.study.study, {}, {}};
  for (const auto& [name, value] : options_with_effect(c))
    source.options.insert(source.options.end(), {name, value});
  IdentifyJob job(source, true);
  return run_study_verb(job, o.study, options, c);
}

}  // namespace

std::unique_ptr<StudyJob> identify_job(const StudySource& source, bool needs_inputs) {
  return std::make_unique<IdentifyJob>(source, needs_inputs);
}

void add_identify(CLI::App& app, CommandLine& line) {
  const auto o = std::make_shared<IdentifyOptions>();
  CLI::App* v =
      verb(app, line, "identify",
           "Find which model and which parameters explain videos of step responses, and how certain both are",
           "  faba identify studies/step-response.toml\n"
           "  faba identify study.toml --engine local --workers 4\n"
           "  faba identify study.toml --engine slurm --engine-set partition=short");
  add_study_options(v, o->study);
  add_part_options(v, o->part);
  v->callback([o, &line] { line.code = identify_verb(*o, line.common); });
}

}  // namespace faba::cli
