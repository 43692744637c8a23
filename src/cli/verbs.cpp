// All verbs, in the order of the help. Each has a file in verbs/.
#include "cli/command_line.h"

namespace faba::cli {

// To add a verb: write its file, which has `void add_NAME(CLI::App& app, CommandLine& line)`, and add its
// line here.
#define FABA_VERBS(X)    \
  X(init)                \
  X(run)                 \
  X(resume)              \
  X(lab)                 \
  X(drop)                \
  X(track)               \
  X(convert)             \
  X(flow)                \
  X(activity)            \
  X(moment)              \
  X(compare)             \
  X(distance)            \
  X(scale)               \
  X(optics)              \
  X(field)               \
  X(rig)                 \
  X(design)              \
  X(tune)                \
  X(compare_controllers) \
  X(benchmark_control)   \
  X(identify)            \
  X(calibrate)           \
  X(study)               \
  X(parts)               \
  X(schema)              \
  X(doctor)

#define FABA_DECLARE(name) void add_##name(CLI::App& app, CommandLine& line);
FABA_VERBS(FABA_DECLARE)
#undef FABA_DECLARE

void add_verbs(CLI::App& app, CommandLine& line) {
#define FABA_ADD(name) add_##name(app, line);
  FABA_VERBS(FABA_ADD)
#undef FABA_ADD
}

}  // namespace faba::cli
