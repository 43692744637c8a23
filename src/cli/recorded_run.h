#pragma once
#include <string>

#include "cli/command_line.h"
#include "cli/progress.h"

namespace faba {
class Session;
}

namespace faba::cli {

/// Runs a session to its end, writes its report and prints a summary; `next`, unless empty, is a command
/// proposed to the user. Returns the exit code.
int run_session(Session& session, Progress& bar, const Common& c, const std::string& next);

}  // namespace faba::cli
