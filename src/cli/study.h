#pragma once
#include <string>

#include "cli/progress.h"
#include "cli/verbs.h"
#include "study/study_directory.h"
#include "study/sweep.h"

namespace faba::cli {

/// Where the study goes: --out, or runs/NAME. `name` of the verb, for the command to go on with.
StudyDirectory open_study(const StudyVerb& v, const std::string& verb, const std::string& fingerprint);

/// Threads, shard, progress and stop of a study. `bar` outlives the sweep. Throws Error(usage, "--shard").
SweepOptions sweep_options(const StudyVerb& v, Progress& bar);

/// Says that other shards have tasks left; returns the exit code.
int tell_partial(const StudyVerb& v, const Common& c, const StudyDirectory& dir);

}  // namespace faba::cli
