#include <fmt/format.h>

#include "cli/study.h"
#include "core/file.h"
#include "study/best_scene.h"
#include "study/identify_report.h"

namespace faba::cli {
namespace {

void summary(const Identification& r) {
  for (const FoundModel& m : r.models) {
    if (!m.failed.empty()) {
      fmt::print("{}: {}\n", m.name, m.failed);
      continue;
    }
    fmt::print("{}: score {:.3f}, fit p {:.2g}, {} simulations\n", m.name, m.score, m.fit_p, m.simulations);
    for (const FoundParameter& p : m.parameters)
      fmt::print("  {:<28} {:.4g} {}  90 % {:.4g} to {:.4g}   (ABC {:.4g}, {:.4g} to {:.4g})\n",
                 p.parameter.path, p.median, p.parameter.unit, p.ci90[0], p.ci90[1], p.abc_median,
                 p.abc_ci90[0], p.abc_ci90[1]);
  }
  fmt::print("{}\n", r.words);
}

}  // namespace

int identify(const StudyVerb& v, const Common& c) {
  const IdentifyStudy study = read_identify_study(v.study);
  Progress bar("simulating", !c.quiet && !c.json);
  SweepOptions options = sweep_options(v, bar);
  StudyDirectory dir = open_study(v, "identify", fingerprint(study));
  const auto result = identify(study, dir.results(), options, [](std::size_t) {});
  bar.clear();
  if (!result) return tell_partial(v, c, dir);
  const auto j = identify_json(*result);
  write_best_scene(*result, dir.path());
  finish(dir, "identify", j, c);
  if (!c.json && !c.quiet) {
    for (const auto& note : j["notes"]) tell("faba: note: " + note.get<std::string>());
    summary(*result);
    fmt::print("wrote {} and best.toml, the scene of the best model\n", (dir.path() / "identify.json").string());
  }
  return 0;
}

}  // namespace faba::cli
