#pragma once
#include <filesystem>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include <nlohmann/json_fwd.hpp>

#include "core/file_lock.h"
#include "study/sweep/result_store.h"

namespace faba {

/// Names in the directory of a study; docs/formats/study-directory.md describes them.
namespace study_files {
inline constexpr const char *kMarker = "incomplete", *kStudy = "study.json", *kResults = "results",
                            *kRounds = "rounds", *kMeasured = "measured", *kJobs = "jobs",
                            *kAttempts = "attempts.csv", *kVideos = "videos";
}  // namespace study_files

/// How to read the study of a directory again; stored in its study.json.
struct StudySource {
  std::string verb;                  ///< "identify"
  std::filesystem::path file;        ///< the study file, as given; empty: `options` name all inputs
  std::vector<std::string> inputs;   ///< digests of the videos
  std::vector<std::string> options;  ///< options of the verb that change the study: "--from", "2"
  /// Working directory of the command, in which paths in `options` are valid; only without a study file.
  std::filesystem::path folder = {};
  bool empty() const { return verb.empty(); }
};

/// What study.json contains.
struct StoredStudy {
  std::string hash, version;
  StudySource source;  ///< `file` and `folder` exist here, also when they are mounted in another place
};
/// Reads study.json of a directory. Throws Error(input) when the directory contains no study or the study
/// file is not found, Error(usage) when another version of the program wrote it.
StoredStudy stored_study(const std::filesystem::path& dir);

/// Whether `dir` contains the complete study with this hash.
bool holds_complete_study(const std::filesystem::path& dir, const std::string& study_hash);
/// Version of the program that wrote the study in `dir`; empty for one of an earlier version.
std::string version_of_study(const std::filesystem::path& dir);
/// Throws Error(input) if one of these directories does not exist or contains no study, Error(usage) if it
/// contains a different one.
void check_merge(const std::vector<std::filesystem::path>& dirs, const std::string& study_hash);

/// The directory with the results of a study. Until the study is complete it contains the file `incomplete`;
/// a study that was stopped or killed is resumed from the stored results.
class StudyDirectory {
 public:
  /// Creates `dir`, or resumes the study in it. `study_hash` is the hash of all inputs of the study,
  /// `resume_command` the command that resumes it. Throws Error(usage) when the directory contains other
  /// files, a different study or (without `force`) the complete study, Error(busy) when another process uses
  /// it. With `force` the results of a different study are deleted; those of the same study are used.
  StudyDirectory(const std::filesystem::path& dir, const std::string& study_hash,
                 const std::string& resume_command, bool force, StudySource source = {});
  /// Deletes a directory that was created for a study that has neither results nor a round nor jobs.
  ~StudyDirectory();
  StudyDirectory(StudyDirectory&&) = default;

  ResultStore& results() { return *results_; }
  const std::filesystem::path& path() const { return dir_; }
  /// Adds the results of other directories of the same study. Throws Error(usage) for a different study,
  /// Error(input) for a directory without a study.
  void merge(const std::vector<std::filesystem::path>& dirs);
  /// Marks the study as complete; call it when everything is written. `more`: added to study.json.
  void complete(const nlohmann::ordered_json& more);

 private:
  std::filesystem::path dir_;
  std::string study_hash_;
  StudySource source_;
  FileLock lock_;
  bool new_ = false, complete_ = false;
  std::unique_ptr<ResultStore> results_;
};

}  // namespace faba
