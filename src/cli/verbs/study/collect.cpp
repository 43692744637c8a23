#include <fmt/format.h>

#include <CLI/CLI.hpp>

#include "cli/command_line.h"
#include "cli/options/study.h"
#include "cli/verbs/study/open_tasks.h"
#include "core/error.h"

namespace faba::cli {
namespace {

// Exit code for job schedulers, in addition to those of all verbs: tasks are open.
constexpr int kOpen = 10;

struct CollectVerb {
  StudyOptions study;
  std::vector<std::filesystem::path> results;
};

int study_collect(CollectVerb v, const Common& c) {
  const StoredStudy stored = stored_study(v.study.out);
  const auto job = study_job(stored.source, true);
  if (job->hash() != stored.hash)
    throw Error(
        Errc::usage, stored.source.file.string(),
        fmt::format("differs from the study that was planned in {}; plan it again in another directory",
                    v.study.out.string()));
  v.study.study = stored.source.file;
  if (!v.results.empty()) {
    ResultStore store(v.study.out / study_files::kResults, stored.hash);
    for (const auto& file : v.results) store.import(file);
  }
  return plan_or_complete(*job, v.study, c) ? 0 : kOpen;
}

}  // namespace

void add_study_collect(CLI::App& study, CommandLine& line) {
  const auto o = std::make_shared<CollectVerb>();
  CLI::App* v = verb(
      study, line, "collect", "Read the results of the workers; plan the next round, or complete the study",
      "  faba study collect runs/mine\n"
      "  faba study collect runs/mine elsewhere/*.results\n\n"
      "Further exit codes: 10 tasks are open, 11 another process uses the directory, try again later");
  v->add_option("dir", o->study.out, "Directory of the study")->required();
  v->add_option("results", o->results, "Result files to copy to the directory; default: only those in it");
  v->add_flag("--force", o->study.force, "Write the pages of a complete study again");
  v->callback([o, &line] { line.code = study_collect(*o, line.common); });
}

}  // namespace faba::cli
