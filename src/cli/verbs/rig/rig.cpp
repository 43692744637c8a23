#include <CLI/CLI.hpp>

#include "cli/command_line.h"

namespace faba::cli {

// To add a verb: write its file, which has `void add_rig_NAME(CLI::App& rig, CommandLine& line)`, and add its
// line here.
#define FABA_RIG_VERBS(X) \
  X(list)                 \
  X(check)                \
  X(capture)              \
  X(jog)                  \
  X(run)                  \
  X(step_response)        \
  X(replay)               \
  X(simulate)

#define FABA_DECLARE(name) void add_rig_##name(CLI::App& rig, CommandLine& line);
FABA_RIG_VERBS(FABA_DECLARE)
#undef FABA_DECLARE

void add_rig(CLI::App& app, CommandLine& line) {
  CLI::App* rig = app.add_subcommand("rig", "The bench: a camera and coils, real or simulated");
  rig->require_subcommand(1);
  rig->footer("Options of a command: faba rig COMMAND --help");
#define FABA_ADD(name) add_rig_##name(*rig, line);
  FABA_RIG_VERBS(FABA_ADD)
#undef FABA_ADD
}

}  // namespace faba::cli
