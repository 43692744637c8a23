#pragma once
#include <filesystem>
#include <string>

namespace faba {

/// The file `incomplete` of a run directory. While a process writes there it holds the file's lock, which the
/// system takes back however the process ends; the file stays until the run is whole.
class RunLock {
 public:
  static constexpr const char* kFile = "incomplete";

  RunLock() = default;
  /// Makes the file if it is not there. `program` is the command to go on with. Throws Error(usage) when
  /// another process is at it, Error(internal) when the file cannot be written.
  RunLock(const std::filesystem::path& dir, const std::string& program);
  RunLock(RunLock&& other) noexcept;
  RunLock& operator=(RunLock&& other) noexcept;
  ~RunLock();
  /// Removes the file: the run is whole.
  void complete();

  /// Whether a directory has such a file, and not somebody's own file of that name.
  static bool marks(const std::filesystem::path& dir);

 private:
  std::filesystem::path file_;
  int descriptor_ = -1;
};

}  // namespace faba
