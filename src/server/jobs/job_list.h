#pragma once
#include <atomic>
#include <condition_variable>
#include <filesystem>
#include <functional>
#include <memory>
#include <mutex>
#include <optional>
#include <thread>
#include <vector>

#include "server/jobs/job.h"

namespace faba {

/// Runs jobs one after the other. Jobs with a kind are kept in their directory, and listed again by the next
/// lab in the same workspace. Thread-safe.
class JobList {
 public:
  /// `changed` is called on the thread of the list, at most a few times per second. `check` is called before
  /// a job starts, which may be long after add(); a job for which it throws fails.
  JobList(std::filesystem::path program, std::filesystem::path workspace, std::function<void()> changed,
          std::function<void(const Job&)> check = {});
  /// Stops the running job and waits for its end.
  ~JobList();

  /// Adds a job to the queue; returns its id.
  int add(Job job);
  /// Stops a running job, or cancels a queued one. False if there is no such job.
  bool cancel(int id);
  /// Moves a queued job before the other queued jobs. False for another state.
  bool move_to_front(int id);
  /// Puts a failed or cancelled job into the queue again: an incomplete study is resumed. False if there is
  /// no such job.
  bool start_again(int id);
  /// Removes an ended job from the list; without an id all ended jobs. Their results are kept. False if there
  /// is not such a job.
  bool clear(std::optional<int> id);
  std::vector<Job> jobs() const;
  std::optional<Job> job(int id) const;

 private:
  struct Process;
  void work(const std::stop_token& stop);
  void carry_out(Job& job, const std::stop_token& stop);
  void report(const Job& job);
  std::vector<Job>::iterator find(int id);  ///< mutex_ must be locked

  std::filesystem::path program_, workspace_;
  std::function<void()> changed_;
  std::function<void(const Job&)> check_;
  mutable std::mutex mutex_;
  std::condition_variable wake_;
  std::vector<Job> jobs_;
  int next_ = 1;
  std::atomic<int> cancel_{0};  ///< id of the running job to stop
  std::jthread thread_;
};

}  // namespace faba
