#pragma once
#include <chrono>
#include <cstdint>
#include <string>

namespace faba::cli {

/// A bar with the time still to go on the last line of the terminal, once the work has lasted a second; a
/// count where it is not known how much there is (total 0). Silent when standard error is no terminal.
/// Where the environment names a file descriptor (FABA_PROGRESS_FD) it is also written there, a line at a
/// time: what, done, total. The live lab follows its jobs so.
class Progress {
 public:
  Progress(std::string what, bool enabled);
  ~Progress();
  Progress(const Progress&) = delete;
  Progress& operator=(const Progress&) = delete;
  void clear();  ///< takes the bar off the terminal; the next update() draws it again
  void update(std::uint64_t done, std::uint64_t total);

 private:
  void tell(std::uint64_t done, std::uint64_t total) const;

  using Clock = std::chrono::steady_clock;
  std::string what_;
  bool enabled_, shown_ = false;
  int told_to_;  ///< file descriptor; -1: nobody
  Clock::time_point began_ = Clock::now(), drawn_ = began_, told_;
  std::uint64_t first_ = 0;  ///< work done before this process: not part of the speed
  bool started_ = false;
};

}  // namespace faba::cli
