#pragma once
#include <string>

#include "cli/command_line.h"
#include "cli/progress.h"

namespace faba {
class Session;
}

namespace faba::cli {

/// Runs a session to its end, writes its report and prints what came of it; `next`, unless empty, is a
/// command that a user may try then. Returns the exit code.
int carry_out(Session& session, Progress& bar, const Common& c, const std::string& next);

}  // namespace faba::cli
