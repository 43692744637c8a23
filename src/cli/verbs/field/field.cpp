#include <CLI/CLI.hpp>

#include "cli/command_line.h"

namespace faba::cli {

// To add a verb: write its file, which has `void add_field_NAME(CLI::App& field, CommandLine& line)`, and add
// its line here.
#define FABA_FIELD_VERBS(X) \
  X(at)                     \
  X(map)                    \
  X(null)                   \
  X(tolerance)              \
  X(fit)                    \
  X(library)

#define FABA_DECLARE(name) void add_field_##name(CLI::App& field, CommandLine& line);
FABA_FIELD_VERBS(FABA_DECLARE)
#undef FABA_DECLARE

void add_field(CLI::App& app, CommandLine& line) {
  CLI::App* field = app.add_subcommand("field", "Magnetic field of a coil system");
  field->require_subcommand(1);
  field->footer("Options of a command: faba field COMMAND --help");
#define FABA_ADD(name) add_field_##name(*field, line);
  FABA_FIELD_VERBS(FABA_ADD)
#undef FABA_ADD
}

}  // namespace faba::cli
