#include "core/threads/ordered_work.h"

#include <algorithm>
#include <system_error>
#include <utility>

#include "core/threads/parallel.h"

namespace faba {

OrderedWork::OrderedWork(unsigned threads, Steps steps) : steps_(std::move(steps)), items_(slots(threads)) {
  try {
    for (unsigned i = 1; i < threads; ++i) threads_.emplace_back([this, i] { run(i); });
  } catch (const std::system_error& e) {
    stop();  // otherwise the destructors of the threads end the program
    throw too_many_threads(threads, threads_.size() + 1, e);
  }
}

unsigned OrderedWork::threads(unsigned wanted) {
  constexpr unsigned kAlwaysPossible = 4;  // so that a test with several threads runs on any machine
  return std::min(number_of_threads(wanted), std::max(number_of_threads(0), kAlwaysPossible));
}

OrderedWork::~OrderedWork() { stop(); }

void OrderedWork::stop() {
  {
    const std::lock_guard lock(mutex_);
    stopped_ = true;
  }
  changed_.notify_all();
  for (std::thread& t : threads_) t.join();
}

std::optional<std::size_t> OrderedWork::next() {
  std::unique_lock lock(mutex_);
  if (std::exchange(held_, false)) {
    ++taken_;
    changed_.notify_all();
  }
  const auto ready = [this] { return taken_ < made_ ? item(taken_).finished : ended_; };
  while (!ready()) {
    take(possible(), lock, 0);
    if (possible() == Step::none) changed_.wait(lock, [&] { return ready() || possible() != Step::none; });
  }
  if (taken_ == made_) return {};
  held_ = true;
  if (const std::exception_ptr failure = item(taken_).failure) std::rethrow_exception(failure);
  return taken_ % items_.size();
}

OrderedWork::Step OrderedWork::possible() const {
  if (started_ < made_) return Step::work;
  return !making_ && !ended_ && made_ - taken_ < items_.size() ? Step::make : Step::none;
}

void OrderedWork::take(Step step, std::unique_lock<std::mutex>& lock, unsigned thread) {
  if (step == Step::none) return;
  if (step == Step::make)
    make(lock);
  else
    work(lock, thread);
  changed_.notify_all();
}

void OrderedWork::make(std::unique_lock<std::mutex>& lock) {
  making_ = true;
  const std::size_t index = made_;
  item(index) = {};
  lock.unlock();
  bool more = true;
  std::exception_ptr failure;
  try {
    more = steps_.make(index % items_.size());
  } catch (...) {
    failure = std::current_exception();
  }
  lock.lock();
  making_ = false;
  item(index).failure = failure;
  ended_ = !more || failure;
  if (more) ++made_;  // an item that failed is the last; the caller receives it after those before it
}

void OrderedWork::work(std::unique_lock<std::mutex>& lock, unsigned thread) {
  const std::size_t index = started_++;
  std::exception_ptr failure = item(index).failure;
  lock.unlock();
  try {
    if (!failure) steps_.work(index % items_.size(), thread);
  } catch (...) {
    failure = std::current_exception();
  }
  lock.lock();
  item(index) = {true, failure};
}

void OrderedWork::run(unsigned thread) {
  std::unique_lock lock(mutex_);
  for (;;) {
    changed_.wait(lock, [this] { return stopped_ || possible() != Step::none; });
    if (stopped_) return;
    take(possible(), lock, thread);
  }
}

}  // namespace faba
