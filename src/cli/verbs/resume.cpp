#include <fmt/format.h>

#include <CLI/CLI.hpp>

#include "app/recording/session.h"
#include "app/scenario/parts.h"
#include "cli/command_line.h"
#include "cli/progress.h"
#include "cli/recorded_run.h"
#include "core/process/child.h"

namespace faba::cli {
namespace {

struct ResumeVerb {
  std::filesystem::path dir;
  unsigned threads = 0;
};

int resume(const ResumeVerb& v, const Common& c) {
  Progress bar("simulating", !c.quiet && !c.json);
  RunOptions o;
  o.out = v.dir;
  o.program = shell_word(program());
  o.threads = v.threads;
  o.progress = [&](std::uint64_t done, std::uint64_t total) { bar.update(done, total); };
  o.stop = &stop_requested();
  Session session = Session::resume(builtin_parts(), o);
  return run_session(session, bar, c, "");
}

}  // namespace

void add_resume(CLI::App& app, CommandLine& line) {
  const auto o = std::make_shared<ResumeVerb>();
  CLI::App* v = verb(app, line, "resume", "Resume an interrupted run from its last checkpoint",
                     "  faba resume runs/steer-1");
  v->add_option("dir", o->dir, "Run directory")->required();
  v->add_option("--threads", o->threads, "Number of threads; default: all threads of the machine")
      ->check(integers(1, 1024));
  v->callback([o, &line] { line.code = resume(*o, line.common); });
}

}  // namespace faba::cli
