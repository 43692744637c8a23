#pragma once
#include <condition_variable>
#include <deque>
#include <exception>
#include <functional>
#include <mutex>
#include <thread>

namespace faba {

/// A thread that runs jobs in the order of add(), so that the caller does not wait for them. At most `most`
/// jobs wait: add() waits for one to end before it adds another. After a job has thrown, no other job is run,
/// and add() and wait() throw its exception. One thread calls the functions. The thread is started by the
/// first add() and has the priority of its caller.
class JobThread {
 public:
  explicit JobThread(std::size_t most) : most_(most) {}
  /// Waits for the running job; waiting jobs are dropped.
  ~JobThread();
  void add(std::function<void()> job);
  /// Returns when all jobs have ended.
  void wait();

 private:
  void work();

  std::size_t most_;
  std::mutex mutex_;
  std::condition_variable changed_;
  std::deque<std::function<void()>> waiting_;
  bool running_ = false, over_ = false;
  std::exception_ptr failure_;
  std::thread thread_;
};

}  // namespace faba
