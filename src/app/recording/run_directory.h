#pragma once
#include <filesystem>
#include <string>

#include "app/recording/run_lock.h"
#include "app/sinks/run_files.h"

namespace faba {

/// The directory of a run that is being written, locked against other processes.
class RunDirectory {
 public:
  struct Options {
    std::filesystem::path out;
    bool numbered = false;         ///< use out-2, out-3 ... if it exists
    bool force = false;            ///< replace an existing run
    std::string program = "faba";  ///< program of the resume command; empty: the run cannot be resumed
  };
  RunDirectory() = default;
  /// Creates the directory, or removes the files of an existing run from it. All checks are done first: on
  /// Error(usage) nothing has been changed.
  static RunDirectory make(const Options& o);
  /// An existing directory.
  RunDirectory(std::filesystem::path path, RunLock lock) : path_(std::move(path)), lock_(std::move(lock)) {}

  const std::filesystem::path& path() const { return path_; }
  /// To be called after the last file is written: the directory is complete.
  void complete();

 private:
  std::filesystem::path path_;
  RunLock lock_;
};

}  // namespace faba
