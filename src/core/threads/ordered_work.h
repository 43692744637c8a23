#pragma once
#include <condition_variable>
#include <cstddef>
#include <exception>
#include <functional>
#include <mutex>
#include <optional>
#include <thread>
#include <vector>

namespace faba {

/// Work on a stream of items by several threads, such as the frames of a video: items are made one after the
/// other, worked on at the same time, and taken by the caller in the order in which they were made. They live
/// in a fixed number of slots of the caller, so memory does not depend on the length of the stream, and
/// results do not depend on the number of threads. The threads work ahead while the caller uses an item.
class OrderedWork {
 public:
  struct Steps {
    /// Makes the next item in `slot`; false at the end. Never called by two threads at a time.
    std::function<bool(std::size_t slot)> make;
    /// Works on an item; called by several threads at a time, `thread` in [0, threads).
    std::function<void(std::size_t slot, unsigned thread)> work;
  };

  /// `threads` >= 1, the calling thread included. Throws Error(internal) when they cannot be started.
  OrderedWork(unsigned threads, Steps steps);
  /// Waits for the steps that run.
  ~OrderedWork();

  /// The number of threads to use when `wanted` are wanted; 0: all. Every thread needs a slot in memory, so
  /// more than can run at a time are not used.
  static unsigned threads(unsigned wanted);
  /// Number of slots for `threads` threads: the items in work, one that the caller holds, and some ahead, so
  /// that the other threads do not wait for an item that takes longer than most.
  static std::size_t slots(unsigned threads) { return threads > 1 ? 3 * threads + 2 : 2; }

  /// The slot of the next item, which is the caller's until the next call; empty at the end. While it is not
  /// finished, the calling thread works as well. Throws what the steps of this item threw.
  std::optional<std::size_t> next();

 private:
  struct Item {
    bool finished = false;
    std::exception_ptr failure;
  };
  enum class Step { none, make, work };
  Step possible() const;
  void take(Step step, std::unique_lock<std::mutex>& lock, unsigned thread);
  void make(std::unique_lock<std::mutex>& lock);
  void work(std::unique_lock<std::mutex>& lock, unsigned thread);
  void run(unsigned thread);
  void stop();
  Item& item(std::size_t index) { return items_[index % items_.size()]; }

  Steps steps_;
  std::vector<Item> items_;
  std::mutex mutex_;
  std::condition_variable changed_;
  // Items are numbered in the order of the stream: taken_ <= started_ <= made_ <= taken_ + slots.
  std::size_t taken_ = 0, started_ = 0, made_ = 0;
  bool held_ = false;  ///< the caller holds item taken_
  bool making_ = false, ended_ = false, stopped_ = false;
  std::vector<std::thread> threads_;
};

}  // namespace faba
