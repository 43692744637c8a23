#pragma once
#include <filesystem>
#include <string>

#include "app/recording/run_lock.h"
#include "app/sinks/run_files.h"

namespace faba {

/// A directory that a run is written to, held against other processes.
class RunDirectory {
 public:
  struct Wish {
    std::filesystem::path out;
    bool numbered = false;         ///< or out-2, out-3 ... when it exists
    bool force = false;            ///< replace an earlier run there
    std::string program = "faba";  ///< the command to go on with; empty: it cannot go on
  };
  RunDirectory() = default;
  /// Makes the directory, or empties one that holds a run of what runs write. All checks come first: on
  /// Error(usage) nothing has been changed.
  static RunDirectory make(const Wish& w);
  /// One that is there already.
  RunDirectory(std::filesystem::path path, RunLock lock) : path_(std::move(path)), lock_(std::move(lock)) {}

  const std::filesystem::path& path() const { return path_; }
  /// Call when the last file is written: the directory is whole.
  void complete();

 private:
  std::filesystem::path path_;
  RunLock lock_;
};

}  // namespace faba
