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
  std::string kind = {};            ///< name of its JobKind; empty: a recording
  double work = 0;                  ///< see work_of()
  double estimate_s = 0;            ///< run time that was estimated before the start; 0: unknown
  bool estimate_measured = false;   ///< from jobs that were complete
  State state = State::waiting;
  std::string doing = {};         ///< "simulating"
  std::uint64_t did = 0, of = 0;  ///< progress; of: total, 0 if unknown
  double seconds = 0;             ///< run time
  double ended = 0;               ///< s since 1970; 0: not ended
  std::string error = {};         ///< error message
  Json result = {};               ///< output of --json
};
/// Everything except the result, which can be large.
Json job_json(const Job& j);
/// Whether a job has ended.
inline bool is_over(const Job& j) { return j.state > Job::State::running; }

/// Runs jobs one after the other. Jobs with a kind are kept in their directory, and listed again by the next
/// lab in the same workspace. Thread-safe.
class JobList {
 public:
  /// `changed` is called on the thread of the list, at most a few times per second.
  JobList(std::filesystem::path program, std::filesystem::path workspace, std::function<void()> changed);
  /// Stops the running job and waits for its end.
  ~JobList();

  /// Adds a job to the queue; returns its id.
  int add(Job job);
  int add(std::string title, std::vector<std::string> words, std::filesystem::path page,
          std::filesystem::path out);
  /// Stops a running job, or cancels a queued one. False if there is no such job.
  bool cancel(int id);
  /// Moves a queued job before the other queued jobs. False if it is not queued.
  bool move_to_front(int id);
  /// Puts a failed or cancelled job into the queue again: an incomplete study is resumed. False if there is
  /// no such job.
  bool start_again(int id);
  /// Removes an ended job from the list; without an id all ended jobs. Their results are kept. False if there
  /// is no such job.
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
  mutable std::mutex mutex_;
  std::condition_variable wake_;
  std::vector<Job> jobs_;
  int next_ = 1;
  std::atomic<int> cancel_{0};  ///< id of the running job to stop
  std::jthread thread_;
};

}  // namespace faba
