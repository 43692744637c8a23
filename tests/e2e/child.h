#pragma once
#include <signal.h>
#include <spawn.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <atomic>
#include <chrono>
#include <filesystem>
#include <functional>
#include <string>
#include <thread>

#include "core/monotonic.h"

extern char** environ;

namespace faba {

/// A shell command in the background, with `exec`, so that the child process is the program. The destructor
/// kills it.
class Child {
 public:
  Child(const std::filesystem::path& folder, const std::string& command) {
    const std::string line = "cd '" + folder.string() + "' && exec " + command;
    const char* const words[] = {"/bin/sh", "-c", line.c_str(), nullptr};
    posix_spawn(&process_, words[0], nullptr, nullptr, const_cast<char* const*>(words), environ);
  }
  ~Child() {
    if (process_ <= 0) return;
    ::kill(process_, SIGCONT);
    ::kill(process_, SIGKILL);
    waitpid(process_, nullptr, 0);
  }
  Child(const Child&) = delete;
  Child& operator=(const Child&) = delete;

  void signal(int s) const { ::kill(process_, s); }
  /// Waits for the end of the process; its exit code, or 128 + signal if it was killed.
  int wait() {
    int status = 0;
    waitpid(process_, &status, 0);
    process_ = -1;
    return WIFEXITED(status) ? WEXITSTATUS(status) : 128 + WTERMSIG(status);
  }
  /// Whether the process has ended; wait() can still be called.
  bool ended() const {
    siginfo_t how{};
    return process_ <= 0 ||
           (waitid(P_PID, id_t(process_), &how, WEXITED | WNOHANG | WNOWAIT) == 0 && how.si_pid != 0);
  }
  pid_t process() const { return process_; }

 private:
  pid_t process_ = -1;
};

/// Measures stalls of this machine: the longest interval, s, in which a thread that wakes every millisecond
/// did not run. Deadlines of 0.1 s in tests are extended by it, up to kMostLate of tests/rig/devices.h. On an
/// idle machine it is a few milliseconds.
class StallMeter {
 public:
  StallMeter()
      : thread_([this](const std::stop_token& stop) {
          for (double last = monotonic_now(); !stop.stop_requested();) {
            std::this_thread::sleep_for(std::chrono::milliseconds(1));
            const double now = monotonic_now();
            longest_ = std::max(longest_.load(), now - last);
            last = now;
          }
        }) {}
  /// Starts a new measurement.
  void begin() { longest_ = 0; }
  double longest() const { return longest_; }

 private:
  std::atomic<double> longest_ = 0;
  std::jthread thread_;
};

/// Whether `happened` becomes true within `patience` s.
inline bool soon(const std::function<bool()>& happened, double patience = 20) {
  for (const double until = monotonic_now() + patience; monotonic_now() < until;) {
    if (happened()) return true;
    std::this_thread::sleep_for(std::chrono::milliseconds(5));
  }
  return false;
}

}  // namespace faba
