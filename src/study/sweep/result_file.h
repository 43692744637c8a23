#pragma once
#include <chrono>
#include <cstdint>
#include <filesystem>
#include <functional>
#include <memory>
#include <span>
#include <string>

#include "core/file.h"
#include "study/sweep/round.h"

namespace faba {

/// Result of one task, or the reason why it failed.
struct TaskResult {
  TaskId id;
  double seconds = 0;              ///< computing time
  std::span<const double> values;  ///< empty for a failed task
  std::string_view failure;        ///< empty for a task that did not fail
};

/// The results of one attempt: binary records, each with a checksum, that one process appends. While the
/// process works the file has the name `file` + ".part"; complete() renames it. Processes share no file, so
/// no locks are needed, and results that exist twice are harmless because they are equal. A process that is
/// killed leaves a .part file whose complete records count. The format is described in
/// docs/formats/study-directory.md.
class ResultFile {
 public:
  /// Creates `file`.part. Throws Error(internal) when it cannot be written.
  ResultFile(std::filesystem::path file, const std::string& study_hash);
  /// Appends a result; at least every few seconds the file is synced to the disk.
  void add(const TaskResult& result);
  /// Syncs the file and renames it to its final name.
  void complete();
  const std::filesystem::path& path() const { return file_; }

 private:
  std::filesystem::path file_;
  OutputFile out_;
  std::chrono::steady_clock::time_point synced_ = std::chrono::steady_clock::now();
};

/// Name of a result file while a process appends to it.
std::filesystem::path partial_name(const std::filesystem::path& file);

/// Reads the records of a result file from byte `from`, 0 at first, and calls `take` for each. Returns where
/// to continue: the end of the last complete record. A record that is torn or damaged ends the reading of a
/// .part file, because the process can still be writing it or was killed; in a complete file it is an error.
/// Throws Error(usage) for a file of another study or of another version of the program, Error(input) for a
/// damaged file.
std::uint64_t read_results(const std::filesystem::path& file, const std::string& study_hash,
                           std::uint64_t from, const std::function<void(const TaskResult&)>& take);

}  // namespace faba
