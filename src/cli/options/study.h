#pragma once
#include <filesystem>
#include <string>
#include <vector>

#include "cli/command_line.h"
#include "cli/progress.h"
#include "study/sweep/study_directory.h"
#include "study/sweep/sweep.h"

#include <nlohmann/json_fwd.hpp>

namespace faba::cli {

/// A study of many simulations, in a directory of its own.
struct StudyOptions {
  std::filesystem::path study, out;
  std::string shard;  ///< "3/16"
  std::vector<std::filesystem::path> merge;
  unsigned threads = 0;
  bool force = false;
};

/// The study file, --out, --shard, --merge, --threads and --force.
void add_study_options(CLI::App* v, StudyOptions& o);

/// Where the study goes: --out, or runs/NAME. `name` of the verb, for the command to go on with.
StudyDirectory open_study(const StudyOptions& v, const std::string& verb, const std::string& study_hash);

/// Whether the study is there already, whole; then this has been said, or its NAME.json printed again.
bool report_if_complete(const StudyOptions& v, const std::string& name, const std::string& study_hash,
                        const Common& c);

/// Threads, shard, progress and stop of a study. `bar` outlives the sweep. Throws Error(usage, "--shard").
SweepOptions sweep_options(const StudyOptions& v, Progress& bar);

/// Writes NAME.json, the last file of a study, and with --json prints it, too, with where it is.
void finish(StudyDirectory& dir, const std::string& name, const nlohmann::ordered_json& j, const Common& c);

/// Says that other shards have tasks left; returns the exit code.
int tell_partial(const StudyOptions& v, const Common& c, const StudyDirectory& dir);

}  // namespace faba::cli
