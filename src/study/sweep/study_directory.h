#pragma once
#include <filesystem>
#include <memory>
#include <string>
#include <vector>

#include "core/file_lock.h"
#include "study/sweep/result_store.h"

namespace faba {

/// Whether `dir` holds a complete study with this hash.
bool holds_complete_study(const std::filesystem::path& dir, const std::string& study_hash);

/// Where a study keeps its results. While it is being made it holds the file `incomplete`; a study that was
/// stopped or killed goes on from the results that are there.
class StudyDirectory {
 public:
  /// Makes `dir`, or resumes the study in it. `study_hash` is the hash of all inputs that the results depend
  /// on. `again` is the command that goes on. Throws Error(usage) when it holds something else, another study
  /// or (without `force`) a complete one, and when another process is at it. With `force` the results of
  /// another study give way; those of the same one are taken.
  StudyDirectory(const std::filesystem::path& dir, const std::string& study_hash, const std::string& again,
                 bool force);
  /// A directory that was made for a study that then came to nothing goes again.
  ~StudyDirectory();
  StudyDirectory(StudyDirectory&&) = default;

  ResultStore& results() { return *results_; }
  const std::filesystem::path& path() const { return dir_; }
  /// Takes over what other directories of the same study hold. Throws Error(usage) for another study's,
  /// Error(input) for those that are none.
  void merge(const std::vector<std::filesystem::path>& dirs);
  /// Everything is written: the study is whole.
  void complete() {
    lock_.complete();
    complete_ = true;
  }

 private:
  std::filesystem::path dir_;
  std::string study_hash_;
  FileLock lock_;
  bool new_ = false, complete_ = false;
  std::unique_ptr<ResultStore> results_;
};

}  // namespace faba
