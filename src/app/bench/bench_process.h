#pragma once
#include <sys/types.h>

#include <filesystem>

#include "app/scenario/scenario.h"

namespace faba {

/// A simulated bench in a separate process, for a run with simulated devices and without the socket of a
/// bench: `faba rig simulate` with its scenario, in real time. It ends with the run.
class BenchProcess {
 public:
  /// Returns when clients can connect. Throws Error(device).
  BenchProcess(const Scenario& s, std::uint64_t seed);
  ~BenchProcess();
  BenchProcess(const BenchProcess&) = delete;
  BenchProcess& operator=(const BenchProcess&) = delete;
  std::string at() const { return (folder_ / "bench").string(); }  ///< path of its socket

 private:
  void end() noexcept;
  std::filesystem::path folder_;  ///< temporary, readable by this user only
  pid_t process_ = -1;
};

}  // namespace faba
