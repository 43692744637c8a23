#pragma once
#include <string>

#include "cli/progress.h"
#include "cli/verbs.h"
#include "study/sweep/study_directory.h"
#include "study/sweep/sweep.h"

#include <nlohmann/json_fwd.hpp>

namespace faba::cli {

/// Where the study goes: --out, or runs/NAME. `name` of the verb, for the command to go on with.
StudyDirectory open_study(const StudyVerb& v, const std::string& verb, const std::string& fingerprint);

/// Whether the study is there already, whole; then this has been said, or its NAME.json printed again.
bool told_complete(const StudyVerb& v, const std::string& name, const std::string& fingerprint,
                   const Common& c);

/// Threads, shard, progress and stop of a study. `bar` outlives the sweep. Throws Error(usage, "--shard").
SweepOptions sweep_options(const StudyVerb& v, Progress& bar);

/// Writes NAME.json, the last file of a study, and with --json prints it, too, with where it is.
void finish(StudyDirectory& dir, const std::string& name, const nlohmann::ordered_json& j, const Common& c);

/// Says that other shards have tasks left; returns the exit code.
int tell_partial(const StudyVerb& v, const Common& c, const StudyDirectory& dir);

}  // namespace faba::cli
