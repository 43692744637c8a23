#pragma once
#include <sys/types.h>

#include <filesystem>

#include "app/scenario/scenario.h"

namespace faba {

/// A simulated bench in a process of its own, for a run that names none: `faba rig simulate` of its scenario,
/// in real time. It ends with the run.
class BenchProcess {
 public:
  /// Returns when it can be connected to. Throws Error(device).
  BenchProcess(const Scenario& s, std::uint64_t seed);
  ~BenchProcess();
  BenchProcess(const BenchProcess&) = delete;
  BenchProcess& operator=(const BenchProcess&) = delete;
  std::string at() const { return (folder_ / "bench").string(); }  ///< its socket

 private:
  void end() noexcept;
  std::filesystem::path folder_;  ///< of its own, for nobody else to read
  pid_t process_ = -1;
};

}  // namespace faba
