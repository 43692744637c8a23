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

/// A job started by a page: one call of the program in a separate process, so that it can be stopped at any
/// time and cannot crash the lab.
struct Job {
  enum class State { waiting, running, done, failed, cancelled };
  int id = 0;
  std::string title;                ///< "Record steer"
  std::vector<std::string> words;   ///< command-line arguments
  std::filesystem::path page, out;  ///< result page and output directory, relative to the workspace
  State state = State::waiting;
  std::string doing;              ///< "simulating"
  std::uint64_t did = 0, of = 0;  ///< progress; of: total, 0 if unknown
  double seconds = 0;             ///< run time
  std::string error;              ///< error message
  Json result;                    ///< output of --json
};
Json job_json(const Job& j);

/// Runs jobs one after the other. Thread-safe.
class JobList {
 public:
  /// `changed` is called on the thread of the list, at most a few times per second.
  JobList(std::filesystem::path program, std::filesystem::path workspace, std::function<void()> changed);
  /// Stops the running job and waits for its end.
  ~JobList();

  int add(std::string title, std::vector<std::string> words, std::filesystem::path page,
          std::filesystem::path out);
  /// Stops a running job, or cancels a queued one. False if there is no such job.
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
  std::atomic<int> cancel_{0};  ///< id of the running job to stop
  std::jthread thread_;
};

}  // namespace faba
