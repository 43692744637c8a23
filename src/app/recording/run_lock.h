#pragma once
#include <filesystem>
#include <string>

#include "app/sinks/run_files.h"
#include "core/file_lock.h"

namespace faba {

/// The file `incomplete` of a run directory, locked while a process writes the run.
class RunLock {
 public:
  static constexpr const char* kFile = run_files::kMarker;

  RunLock() = default;
  /// Creates the file if necessary. `program` is the program of the resume command; empty: the run cannot be
  /// resumed. Throws Error(usage) if another process holds it, Error(internal) if the file cannot be written.
  RunLock(const std::filesystem::path& dir, const std::string& program);
  /// Removes the file: the run is complete.
  void complete() { lock_.complete(); }

  /// Whether a directory has such a file, and not an unrelated file of that name.
  static bool marks(const std::filesystem::path& dir);
  /// Whether a process is writing a run to this directory.
  static bool held(const std::filesystem::path& dir) { return FileLock::held(dir / kFile); }

 private:
  FileLock lock_;
};

}  // namespace faba
