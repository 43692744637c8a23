#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <nlohmann/json.hpp>

#include "app/scenario/file_kind.h"
#include "cli/command_line.h"
#include "cli/options/study.h"
#include "cli/verbs/study/open_tasks.h"
#include "core/counted.h"
#include "core/error.h"

namespace faba::cli {
namespace {

std::string verb_of(const std::filesystem::path& study) {
  const Document d = read_toml(study);
  const auto kind = file_kind(Node(d));
  if (kind == FileKind::identify_study) return "identify";
  if (kind == FileKind::calibration_study) return "calibrate";
  if (kind == FileKind::controller_study) return "compare-controllers";
  if (kind == FileKind::control_benchmark) return "benchmark-control";
  if (kind == FileKind::activity_study) return "activity";
  throw Error(
      Errc::usage, study.string(),
      "is not a study that can be planned; it must be a study for `faba identify`, `faba calibrate`, `faba "
      "compare-controllers`, `faba benchmark-control` or `faba activity`");
}

int study_plan(const StudyOptions& v, const Common& c) {
  StudySource source{verb_of(v.study), v.study, {}, {}};
  if (source.verb == "activity") {  // its inputs are words of the command
    source.options = {v.study.string()};
    source.file.clear();
  }
  const auto job = study_job(source, true);
  plan_or_complete(*job, v, c);
  return 0;
}

}  // namespace

bool plan_or_complete(StudyJob& job, const StudyOptions& v, const Common& c) {
  SweepOptions options = sweep_options(v);
  std::optional<RoundPlanner> planner;
  options.elsewhere = [&](const Round& round, ResultStore& store) {
    if (!planner) planner.emplace(store.folder().parent_path());
    return (*planner)(round, store);
  };
  const auto dir = run_study(job, v, std::move(options), c);
  if (!dir) return true;
  const std::string open = number_list(planner->open_tasks());
  if (c.json)
    fmt::print("{}\n", nlohmann::ordered_json{{"out", dir->string()},
                                              {"complete", false},
                                              {"open", planner->open_tasks().size()},
                                              {"tasks", open}}
                           .dump());
  else if (!c.quiet)
    fmt::print("{}: {} open: {}\n", dir->string(),
               counted(std::uint64_t(planner->open_tasks().size()), "task"), open);
  return false;
}

void add_study_plan(CLI::App& study, CommandLine& line) {
  const auto o = std::make_shared<StudyOptions>();
  CLI::App* v = verb(study, line, "plan",
                     "Write the tasks of a study to its directory, so that workers can compute them anywhere",
                     "  faba study plan study.toml --out runs/mine\n"
                     "  faba study work runs/mine --tasks 1-100 --results runs/mine/results/a.results\n"
                     "  faba study collect runs/mine");
  v->add_option("study", o->study,
                "Study file (TOML) of identify, calibrate, compare-controllers or activity")
      ->required()
      ->transform(or_example("studies"));
  v->add_option("-o,--out", o->out, "Directory of the study; default: runs/NAME")->check(not_empty);
  v->add_flag("--force", o->force, "Replace another study in the directory");
  v->callback([o, &line] { line.code = study_plan(*o, line.common); });
}

}  // namespace faba::cli
