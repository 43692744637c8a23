#include "core/threads/parallel.h"

#include <string>

namespace faba {
namespace {

// A job arrives every few microseconds while a simulation runs: spin for a short time before sleeping.
constexpr int kSpins = 2000;

void relax() {
#if defined(__x86_64__)
  __builtin_ia32_pause();
#endif
}

}  // namespace

Error too_many_threads(unsigned wanted, std::size_t started, const std::system_error& e) {
  return {Errc::internal, "--threads",
          std::to_string(wanted) + " threads cannot be started, only " + std::to_string(started) + " (" +
              e.code().message() + "); give a smaller number"};
}

unsigned number_of_threads(unsigned threads) {
  return threads > 0 ? threads : std::max(1u, std::thread::hardware_concurrency());
}

Pool::Pool(unsigned threads) {
  threads = number_of_threads(threads);
  try {
    for (unsigned i = 1; i < threads; ++i) workers_.emplace_back([this, i] { work(i); });
  } catch (const std::system_error& e) {
    stop();  // the threads already started wait for work; without this their destructors would block
    throw too_many_threads(threads, workers_.size() + 1, e);
  }
}

Pool::~Pool() { stop(); }

void Pool::stop() {
  stopping_.store(true, std::memory_order_relaxed);
  round_.fetch_add(1, std::memory_order_release);
  round_.notify_all();
  for (auto& w : workers_) w.join();
}

void Pool::run_share(unsigned index) {
  const std::size_t n = threads(), begin = blocks_ * index / n, end = blocks_ * (index + 1) / n;
  try {
    for (std::size_t b = begin; b < end && !failed_.load(std::memory_order_relaxed); ++b) (*job_)(b);
  } catch (...) {
    if (!failed_.exchange(true)) error_ = std::current_exception();
  }
}

void Pool::work(unsigned index) {
  std::uint32_t seen = 0;
  for (;;) {
    for (int i = 0; i < kSpins && round_.load(std::memory_order_acquire) == seen; ++i) relax();
    round_.wait(seen, std::memory_order_acquire);
    if (stopping_.load(std::memory_order_relaxed)) return;
    seen = round_.load(std::memory_order_acquire);
    run_share(index);
    if (pending_.fetch_sub(1, std::memory_order_acq_rel) == 1) pending_.notify_one();
  }
}

void Pool::run(std::size_t blocks, const std::function<void(std::size_t)>& job) {
  if (workers_.empty() || blocks <= 1) {
    for (std::size_t b = 0; b < blocks; ++b) job(b);
    return;
  }
  job_ = &job;
  blocks_ = blocks;
  failed_ = false;
  error_ = nullptr;
  pending_.store(std::uint32_t(workers_.size()), std::memory_order_relaxed);
  round_.fetch_add(1, std::memory_order_release);
  round_.notify_all();
  run_share(0);
  for (int i = 0; i < kSpins && pending_.load(std::memory_order_acquire) != 0; ++i) relax();
  for (auto left = pending_.load(std::memory_order_acquire); left != 0;
       left = pending_.load(std::memory_order_acquire))
    pending_.wait(left, std::memory_order_acquire);
  if (error_) std::rethrow_exception(error_);
}

void Pool::run_uneven(std::size_t blocks, const std::function<void(std::size_t)>& job) {
  std::atomic<std::size_t> next{0};
  run(threads(), [&](std::size_t) {
    for (std::size_t b; !failed_.load(std::memory_order_relaxed) && (b = next++) < blocks;) job(b);
  });
}

}  // namespace faba
