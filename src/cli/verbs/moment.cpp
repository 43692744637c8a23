#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <nlohmann/json.hpp>

#include "cli/command_line.h"
#include "cli/options/video_part.h"
#include "cli/progress.h"
#include "cli/provenance.h"
#include "cli/quality_text.h"
#include "study/pages/moment_report.h"
#include "study/quality/rounded.h"
#include "study/uturn/moment_study.h"

namespace faba::cli {
namespace {

struct MomentVerb {
  std::filesystem::path study;
  unsigned threads = 0;
};

// A median with its interval, in `unit`, which is `si` of the SI unit.
std::string in_unit(const MedianInterval& m, double si, const char* unit) {
  const RoundedInterval r = rounded_interval(m.median / si, {m.ci90[0] / si, m.ci90[1] / si});
  return fmt::format("{} {} (90 % interval {} to {})", r.value, unit, r.low, r.high);
}

void print_moment(const MomentEstimate& e) {
  for (const FieldStrength& f : e.fields) {
    if (!f.rate_per_t) {
      fmt::print("{:<9.4g} mT  no complete turns\n", 1e3 * f.field_t);
      continue;
    }
    fmt::print("{:<9.4g} mT  {} turns, {}\n", 1e3 * f.field_t, f.survey.turns.size(),
               in_unit(*f.rate_per_t, 1e3, "rad/(s mT)"));
  }
  if (quality_of(e.warnings) == Quality::poor) {
    fmt::print("the moment is not stated, because the quality is poor; --json gives all values\n");
    return;
  }
  if (e.rate_per_t)
    fmt::print("rate      {}, median of the cells\n", in_unit(*e.rate_per_t, 1e3, "rad/(s mT)"));
  if (e.moment) fmt::print("moment    {}, median of the cells\n", in_unit(*e.moment, 1e-15, "fA m^2"));
}

int moment(const MomentVerb& v, const Common& c) {
  MomentJob job;
  read_moment_study(v.study, job);
  Progress bar("tracking", !c.quiet && !c.json);
  job.threads = v.threads;
  job.progress = [&](const std::string&, std::uint64_t done, std::uint64_t total) {
    bar.update(done, total);
  };
  job.stop = [] { return bool(stop_requested()); };
  const MomentEstimate estimate = measure_moment(job);
  bar.clear();
  if (c.json) {
    std::vector<std::filesystem::path> inputs{v.study};
    for (const MomentVideo& video : job.videos) inputs.push_back(video.file);
    print_json(moment_json(estimate), provenance_of(c, inputs));
    return 0;
  }
  if (c.quiet) return 0;
  print_moment(estimate);
  print_quality(estimate.warnings, 10);
  return 0;
}

}  // namespace

void add_moment(CLI::App& app, CommandLine& line) {
  const auto o = std::make_shared<MomentVerb>();
  CLI::App* v = verb(app, line, "moment",
                     "Estimate the magnetic moment of cells from their U-turns after field reversals",
                     "  faba moment turns.toml\n  faba moment turns.toml --json");
  v->add_option("study", o->study,
                "Study file (TOML): the body of the cells, and videos with field and reversals")
      ->required();
  add_threads_option(v, o->threads);
  v->callback([o, &line] { line.code = moment(*o, line.common); });
}

}  // namespace faba::cli
