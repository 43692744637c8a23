#pragma once
#include <filesystem>
#include <string>
#include <vector>

#include "cli/command_line.h"
#include "cli/progress.h"
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
};

/// Adds the study file, --out, --shard, --merge, --threads and --force.
void add_study_options(CLI::App* v, StudyOptions& o);

/// Opens the directory of the study: --out, or runs/NAME. `verb` is its name, for the command that resumes
/// the study.
StudyDirectory open_study(const StudyOptions& v, const std::string& verb, const std::string& study_hash);

/// Whether the directory has the complete study; if so, reports it or, with --json, prints its NAME.json
/// again.
bool report_if_complete(const StudyOptions& v, const std::string& name, const std::string& study_hash,
                        const Common& c);

/// Threads, shard, progress and stop of a study. `bar` must outlive the sweep. Throws Error(usage,
/// "--shard").
SweepOptions sweep_options(const StudyOptions& v, Progress& bar);

/// Writes NAME.json with the provenance, the last file of a study, and date, threads and directory to
/// study.json.
void finish(StudyDirectory& dir, const std::string& name, nlohmann::ordered_json j, const Provenance& p,
            const StudyOptions& v);
/// Prints NAME.json of a complete study, with the directory.
void print_study(const StudyDirectory& dir, const std::string& name);

/// Reports that other shards have pending tasks; returns the exit code.
int report_partial(const StudyOptions& v, const Common& c, const StudyDirectory& dir);

}  // namespace faba::cli
