#include <CLI/CLI.hpp>

#include "cli/command_line.h"
#include "cli/verbs.h"

namespace faba::cli {
namespace {

void add_options(CLI::App* v, StudyVerb& o) {
  v->add_option("study", o.study, "Study file (TOML)")->required();
  v->add_option("-o,--out", o.out,
                "Directory of the study; runs/NAME when absent. One that is not complete goes on")
      ->check(not_empty);
  v->add_option("--shard", o.shard,
                "Do only this part of the simulations, such as 3/16, for one of several machines")
      ->check(not_empty);
  v->add_option("--merge", o.merge,
                "Take over the results in these directories of the same study, then go on");
  v->add_option("--threads", o.threads, "Threads; all of the machine's when absent. Never changes the result")
      ->check(CLI::Range(1, 1024));
  v->add_flag("--force", o.force,
              "Replace another study in the directory, or write a complete one's pages again");
}

}  // namespace

void add_study_verbs(CLI::App& app, CommandLine& line) {
  const auto o = std::make_shared<StudyVerb>();
  CLI::App* v = verb(app, line, "compare-controllers",
                     "Controllers with several models and delays, each over many seeds",
                     "  faba compare-controllers studies/controllers.toml\n"
                     "  faba compare-controllers study.toml --out runs/mine --threads 1");
  add_options(v, *o);
  v->callback([o, &line] { line.code = compare_controllers(*o, line.common); });

  const auto i = std::make_shared<StudyVerb>();
  v = verb(app, line, "identify",
           "Which model and which parameters explain videos of step responses, and how sure that is",
           "  faba identify studies/step-response.toml\n"
           "  faba identify study.toml --out runs/part3 --shard 3/16\n"
           "  faba identify study.toml --out runs/all --merge runs/part1 --merge runs/part2");
  add_options(v, *i);
  v->callback([i, &line] { line.code = identify(*i, line.common); });
}

}  // namespace faba::cli
