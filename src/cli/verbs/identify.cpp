#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <algorithm>

#include "cli/command_line.h"
#include "cli/options/study.h"
#include "cli/options/video_part.h"
#include "cli/provenance.h"
#include "cli/quality_text.h"
#include "core/file.h"
#include "study/identify/best_scene.h"
#include "study/identify/identify_warnings.h"
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

int identify(const IdentifyOptions& o, const Common& c) {
  const StudyOptions& v = o.study;
  Progress bar("simulating", !c.quiet && !c.json);
  SweepOptions options = sweep_options(v, bar);  // errors of options come before those of the study
  const VideoPart part = o.part.part();
  IdentifyStudy study = read_identify_study(v.study);
  select_part(study, part);
  const std::string hash = study_hash(study);
  if (report_if_complete(v, "identify", hash, c)) return 0;
  StudyDirectory dir = open_study(v, "identify", hash);
  Progress reader("reading frames", !c.quiet && !c.json);
  std::uint64_t frames = 0;
  const auto simulating = options.progress;
  options.progress = [&](std::uint64_t done, std::uint64_t total) {
    reader.clear();
    simulating(done, total);
  };
  const auto result = identify(study, dir.results(), options, [&] { reader.update(++frames, 0); });
  reader.clear();
  bar.clear();
  if (!result) return report_partial(v, c, dir);
  write_best_scene(*result, dir.path());
  std::vector<std::filesystem::path> inputs{v.study};
  for (const ResponseInput& video : study.videos) inputs.push_back(video.file);
  const Provenance provenance = provenance_of(c, inputs);
  write_file(dir.path() / "identify.html", identify_page(*result, provenance));
  finish(dir, "identify", identify_json(*result), provenance, v);
  if (c.json) print_study(dir, "identify");
  if (!c.json && !c.quiet) {
    for (const std::string& note : notes_of(*result)) print_stderr("faba: note: " + note);
    summary(*result);
    print_quality(identify_warnings(*result));
    fmt::print("wrote {} and best.toml, the scenario of the best model\n",
               (dir.path() / "identify.html").string());
  }
  return 0;
}

}  // namespace

void add_identify(CLI::App& app, CommandLine& line) {
  const auto o = std::make_shared<IdentifyOptions>();
  CLI::App* v =
      verb(app, line, "identify",
           "Find which model and which parameters explain videos of step responses, and how certain both are",
           "  faba identify studies/step-response.toml\n"
           "  faba identify study.toml --out runs/part3 --shard 3/16\n"
           "  faba identify study.toml --out runs/all --merge runs/part1 --merge runs/part2");
  add_study_options(v, o->study);
  add_part_options(v, o->part);
  v->callback([o, &line] { line.code = identify(*o, line.common); });
}

}  // namespace faba::cli
