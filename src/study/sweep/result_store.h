#pragma once
#include <filesystem>
#include <functional>
#include <map>
#include <memory>
#include <mutex>
#include <optional>
#include <span>
#include <string>
#include <unordered_map>
#include <vector>

#include "study/sweep/result_file.h"
#include "study/sweep/round.h"

namespace faba {

/// Key of a round: hash of the version of the program, the study and the description of the round. It does
/// not depend on paths, because the hash of the study does not.
std::uint64_t round_key(const std::string& study_hash, const Round& round);

/// The results of the tasks of a study: those in the result files of a folder, which other processes may be
/// writing, and those that this process adds, in a result file of its own. Memory: 16 bytes per task and 8
/// per value.
class ResultStore {
 public:
  /// Reads all results in `folder`, which is created when the first result is added. With an empty `folder`
  /// the results are in memory only. Throws as read_results().
  ResultStore(std::filesystem::path folder, std::string study_hash);
  ~ResultStore();

  std::uint64_t key(const Round& round) const { return round_key(study_hash_, round); }
  /// The result of a task; empty if the store has no result of it. Valid as long as the store.
  std::optional<std::span<const double>> find(TaskId id) const;
  /// Stores a result; an existing result is not changed. `seconds`: computing time. Several threads may call
  /// it.
  void add(TaskId id, std::span<const double> values, double seconds = 0);
  /// Reads what other processes have written since the last call. Returns whether there are new results or
  /// failures; calls `taken` for each new result.
  bool read_new(const std::function<void(TaskId)>& taken = {});
  /// Copies the result files of another folder that this one does not have, and reads them.
  void merge(const std::filesystem::path& folder);
  /// Copies a result file to the folder and reads it.
  void import(const std::filesystem::path& file);

  bool empty() const { return size_ == 0; }
  std::size_t size() const { return size_; }
  const std::string& study_hash() const { return study_hash_; }
  const std::filesystem::path& folder() const { return folder_; }

  /// Failures of a task, one for each attempt.
  struct Failures {
    int attempts = 0;
    std::string what;  ///< of the last attempt
  };
  /// Tasks of a round that failed and have no result.
  std::map<std::uint64_t, Failures> failures(std::uint64_t round) const;
  /// Mean computing time of the tasks of a round that have a result, s; of all rounds if it has none. Empty
  /// if there are no results.
  std::optional<double> seconds_per_task(std::uint64_t round) const;

 private:
  struct Values {
    const double* first = nullptr;  ///< null: no result
    std::uint32_t count = 0;
  };
  struct Results {
    std::vector<Values> tasks;
    double seconds = 0;
    std::uint64_t done = 0;
    std::map<std::uint64_t, Failures> failures;
  };
  struct Reading {
    std::uint64_t from = 0;  ///< byte of the file up to which it was read
    bool complete = false;
  };
  bool take(const TaskResult& result);
  double* keep(std::span<const double> values);
  std::string own_name() const;

  std::filesystem::path folder_;
  std::string study_hash_;
  std::unordered_map<std::uint64_t, Results> rounds_;
  std::map<std::string, Reading> files_;  ///< by name without ".part"
  std::vector<std::unique_ptr<double[]>> blocks_;
  std::size_t used_ = 0, block_size_ = 0;  ///< doubles of the last block
  std::size_t size_ = 0;
  std::unique_ptr<ResultFile> own_;
  std::mutex adding_;
};

}  // namespace faba
