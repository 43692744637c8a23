#pragma once
#include "cli/command_line.h"
#include "cli/options/study.h"
#include "study/sweep/round_planner.h"

namespace faba::cli {

/// Plans the next round of a study, or completes the study. Returns true when it is complete; prints the open
/// tasks otherwise.
bool plan_or_complete(StudyJob& job, const StudyOptions& v, const Common& c);

}  // namespace faba::cli
