#pragma once
#include <filesystem>
#include <string>

#include "app/sinks/run_files.h"
#include "core/file_lock.h"

namespace faba {

/// The file `incomplete` of a run directory, held while a process writes there.
class RunLock {
 public:
  static constexpr const char* kFile = run_files::kMarker;

  RunLock() = default;
  /// Makes the file if it is not there. `program` is the command to go on with; empty: what was broken off
  /// cannot go on. Throws Error(usage) when another process is at it, Error(internal) when the file cannot be
  /// written.
  RunLock(const std::filesystem::path& dir, const std::string& program);
  /// Removes the file: the run is whole.
  void complete() { lock_.complete(); }

  /// Whether a directory has such a file, and not somebody's own file of that name.
  static bool marks(const std::filesystem::path& dir);

 private:
  FileLock lock_;
};

}  // namespace faba
