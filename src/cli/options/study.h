#pragma once
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "cli/command_line.h"
#include "cli/options/engine.h"
#include "cli/study_job.h"
#include "study/data/provenance.h"
#include "study/sweep/study_directory.h"
#include "study/sweep/sweep.h"

#include <nlohmann/json_fwd.hpp>

namespace faba::cli {

/// Options of a study of many simulations.
struct StudyOptions {
  std::filesystem::path study, out;
  std::string shard;  ///< "3/16"
  std::vector<std::filesystem::path> merge;
  unsigned threads = 0;
  bool force = false;
  EngineOptions engine = {};
};

/// Adds --out, whose help names `folder` as the default, --threads, --force, and the options of engines.
void add_study_run_options(CLI::App* v, StudyOptions& o, const std::string& folder);
/// Adds the study file, --out, --shard, --merge, --threads, --force, and the options of engines.
void add_study_options(CLI::App* v, StudyOptions& o);

/// Threads, shard and stop of a study. Throws Error(usage), also for wrong options of engines.
SweepOptions sweep_options(const StudyOptions& v);

/// Runs a study in its directory, --out or runs/NAME, up to the end: the only function that does so. Prints
/// the result, also of a study that is complete already. Returns the directory when results are missing that
/// `options` do not compute, empty when the study is complete.
std::optional<std::filesystem::path> run_study(StudyJob& job, const StudyOptions& v, SweepOptions options,
                                               const Common& c);
/// run_study() for a verb: with its engine, and with a message and exit code 0 when other shards have tasks
/// left.
int run_study_verb(StudyJob& job, const StudyOptions& v, const SweepOptions& options, const Common& c);

/// The study file and the options that change the result.
Provenance study_provenance(const StudySource& source);
/// Writes NAME.json with the provenance, the last file of a study, and date, threads and directory to
/// study.json.
void finish(StudyDirectory& dir, const std::string& name, nlohmann::ordered_json j, const Provenance& p,
            unsigned threads);
/// Prints NAME.json of a complete study, with the directory.
void print_study(const StudyDirectory& dir, const std::string& name);

}  // namespace faba::cli
