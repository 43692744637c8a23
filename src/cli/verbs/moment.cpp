#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <nlohmann/json.hpp>

#include "cli/command_line.h"
#include "cli/options/video_part.h"
#include "cli/progress.h"
#include "cli/provenance.h"
#include "cli/quality_text.h"
#include "study/pages/moment_report.h"
#include "study/uturn/moment_study.h"

namespace faba::cli {
namespace {

struct MomentVerb {
  std::filesystem::path study;
  unsigned threads = 0;
};

void print_moment(const MomentEstimate& e) {
  for (const FieldStrength& f : e.fields) {
    if (!f.rate_per_t) {
      fmt::print("{:<9.4g} mT  no complete turns\n", 1e3 * f.field_t);
      continue;
    }
    fmt::print("{:<9.4g} mT  {} turns, {:.3g} rad/(s mT) (90 % interval {:.3g} to {:.3g})\n", 1e3 * f.field_t,
               f.survey.turns.size(), 1e-3 * f.rate_per_t->median, 1e-3 * f.rate_per_t->ci90[0],
               1e-3 * f.rate_per_t->ci90[1]);
  }
  if (quality_of(e.warnings) == Quality::poor) {
    fmt::print("the moment is not stated, because the quality is poor; --json gives all values\n");
    return;
  }
  if (e.rate_per_t)
    fmt::print("rate      {:.3g} rad/(s mT), median of the cells (90 % interval {:.3g} to {:.3g})\n",
               1e-3 * e.rate_per_t->median, 1e-3 * e.rate_per_t->ci90[0], 1e-3 * e.rate_per_t->ci90[1]);
  if (e.moment)
    fmt::print("moment    {:.2g} A m^2, median of the cells (90 % interval {:.2g} to {:.2g})\n",
               e.moment->median, e.moment->ci90[0], e.moment->ci90[1]);
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
