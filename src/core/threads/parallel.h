#pragma once
#include <atomic>
#include <cstddef>
#include <exception>
#include <functional>
#include <system_error>
#include <thread>
#include <vector>

#include "core/error.h"

namespace faba {

/// The error for `wanted` threads of which only `started` could be started.
Error too_many_threads(unsigned wanted, std::size_t started, const std::system_error& e);

/// `threads`, or the number of hardware threads if it is 0.
unsigned number_of_threads(unsigned threads);

/// Thread pool. Work is divided into fixed blocks, so the result of a block does not depend on the number of
/// threads. The calling thread takes part; with one thread no other is started.
class Pool {
 public:
  /// `threads` >= 1; 0: number of hardware threads. Throws Error(internal) if they cannot be started.
  explicit Pool(unsigned threads = 0);
  ~Pool();
  Pool(const Pool&) = delete;
  Pool& operator=(const Pool&) = delete;

  unsigned threads() const { return unsigned(workers_.size()) + 1; }

  /// Calls job(block) once for each block in [0, blocks), each thread a contiguous range; returns when
  /// all are done. The first exception thrown by a job is rethrown here.
  void run(std::size_t blocks, const std::function<void(std::size_t)>& job);

  /// Like run(), for blocks of different durations: each thread takes the next block when it is free.
  void run_uneven(std::size_t blocks, const std::function<void(std::size_t)>& job);

  /// run() over [0, n) in blocks of `block` elements: job(begin, end).
  template <class Job>
  void for_blocks(std::size_t n, std::size_t block, Job&& job) {
    run((n + block - 1) / block,
        [&](std::size_t b) { job(b * block, b * block + block < n ? b * block + block : n); });
  }

 private:
  void work(unsigned index);
  void stop();
  void run_share(unsigned index);

  std::vector<std::thread> workers_;
  const std::function<void(std::size_t)>* job_ = nullptr;
  std::size_t blocks_ = 0;
  std::atomic<std::uint32_t> round_{0};    ///< incremented to start a job
  std::atomic<std::uint32_t> pending_{0};  ///< workers that have not finished it
  std::atomic<bool> failed_{false};
  std::atomic<bool> stopping_{false};
  std::exception_ptr error_;
};

}  // namespace faba
