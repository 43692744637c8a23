#include <CLI/CLI.hpp>

#include "cli/command_line.h"

namespace faba::cli {

// To add a verb: write its file, which has `void add_study_NAME(CLI::App& study, CommandLine& line)`, and add
// its line here.
#define FABA_STUDY_VERBS(X) \
  X(plan)                   \
  X(work)                   \
  X(collect)                \
  X(export)

#define FABA_DECLARE(name) void add_study_##name(CLI::App& study, CommandLine& line);
FABA_STUDY_VERBS(FABA_DECLARE)
#undef FABA_DECLARE

void add_study(CLI::App& app, CommandLine& line) {
  CLI::App* study = app.add_subcommand("study", "Tasks of a study, for any job scheduler");
  study->require_subcommand(1);
  study->footer("Options of a command: faba study COMMAND --help");
#define FABA_ADD(name) add_study_##name(*study, line);
  FABA_STUDY_VERBS(FABA_ADD)
#undef FABA_ADD
}

}  // namespace faba::cli
