#pragma once
#include <chrono>
#include <cstdint>
#include <functional>
#include <string>

namespace faba::cli {

/// Progress bar with the remaining time on the last line of the terminal, shown when the work takes longer
/// than a second; a counter if the total is unknown (0). Shows nothing if standard error is not a terminal.
/// If the environment variable FABA_PROGRESS_FD has a file descriptor, progress is also written there, one
/// line per update: label, done, total. The live lab reads the progress of its jobs in this way.
class Progress {
 public:
  Progress(std::string what, bool enabled);
  ~Progress();
  Progress(const Progress&) = delete;
  Progress& operator=(const Progress&) = delete;
  void clear();  ///< erases the bar; the next update() draws it again
  /// `waiting`: what the work waits for, shown instead of the remaining time; this time does not count.
  void update(std::uint64_t done, std::uint64_t total, const std::string& waiting = {});

 private:
  void report(std::uint64_t done, std::uint64_t total) const;

  using Clock = std::chrono::steady_clock;
  std::string what_;
  bool enabled_, shown_ = false;
  int report_descriptor_;  ///< -1: none
  Clock::time_point began_ = Clock::now(), drawn_ = began_, updated_ = began_, reported_;
  std::uint64_t first_ = 0;  ///< work done by an earlier process: not part of the speed
  bool started_ = false;
};

/// Progress of a study of several rounds, each of which reports its own work from 0. `total`: of all rounds.
/// `bar` must outlive the function.
std::function<void(std::uint64_t done, std::uint64_t)> over_rounds(Progress& bar, std::uint64_t total);

}  // namespace faba::cli
