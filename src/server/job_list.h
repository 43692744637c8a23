#pragma once
#include <atomic>
#include <condition_variable>
#include <filesystem>
#include <functional>
#include <memory>
#include <mutex>
#include <thread>
#include <vector>

#include "core/toml.h"

namespace faba {

/// Long work that a page asked for: one call of the program, in a process of its own, so that it can be
/// stopped at any moment and takes nobody with it.
struct Job {
  enum class State { waiting, running, done, failed, cancelled };
  int id = 0;
  std::string title;                ///< "Record steer"
  std::vector<std::string> words;   ///< what follows the program's name, as one would type it
  std::filesystem::path page, out;  ///< what it writes, below the workspace: to be looked at, and kept
  State state = State::waiting;
  std::string doing;              ///< "simulating"
  std::uint64_t did = 0, of = 0;  ///< of: 0 when it is not known
  double seconds = 0;             ///< that it has run
  std::string error;              ///< why it failed
  Json result;                    ///< what --json said
};
Json job_json(const Job& j);

/// Does jobs one after the other. Thread-safe.
class JobList {
 public:
  /// `changed` is called on the list's thread, a few times a second at most.
  JobList(std::filesystem::path program, std::filesystem::path workspace, std::function<void()> changed);
  /// Stops what is running, and waits until it has come to an end.
  ~JobList();

  int add(std::string title, std::vector<std::string> words, std::filesystem::path page,
          std::filesystem::path out);
  /// Asks a job to stop, or takes it from the list when it has not begun. False when there is none.
  bool cancel(int id);
  std::vector<Job> jobs() const;

 private:
  struct Process;
  void work(const std::stop_token& stop);
  void carry_out(Job& job, const std::stop_token& stop);
  void report(const Job& job);

  std::filesystem::path program_, workspace_;
  std::function<void()> changed_;
  mutable std::mutex mutex_;
  std::condition_variable wake_;
  std::vector<Job> jobs_;
  int next_ = 1;
  std::atomic<int> cancel_{0};  ///< id of the running job that is to stop
  std::jthread thread_;
};

}  // namespace faba
