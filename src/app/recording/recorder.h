#pragma once
#include <condition_variable>
#include <deque>
#include <exception>
#include <mutex>
#include <thread>

#include "app/loop/loop.h"

namespace faba {

/// Hands every turn to its sinks in a thread of its own, so that a loop in real time does not wait for a
/// disk. It loses nothing: when the sinks are `kMost` turns behind, the loop waits after all.
class Recorder final : public Sink {
 public:
  static constexpr std::size_t kMost = 300;  // 90 MB of 640 x 480 px

  /// `sinks` outlive it; nobody else calls them until finish().
  explicit Recorder(std::vector<Sink*> sinks);
  ~Recorder() override;
  /// Throws what a sink threw at an earlier turn.
  void take(const Tick& t) override;
  /// Returns when all turns are with the sinks. Throws what one of them threw.
  void finish();
  std::size_t most_behind() const { return most_behind_; }  ///< turns

 private:
  struct Kept {
    std::uint64_t index;
    Observation seen;
    Estimate estimate;
    Target target;
    Command command;
    bool limited;
  };
  void work();

  std::vector<Sink*> sinks_;
  std::mutex mutex_;
  std::condition_variable changed_;
  std::deque<Kept> waiting_;
  std::size_t most_behind_ = 0;
  bool over_ = false;
  std::exception_ptr failure_;
  std::thread thread_;
};

}  // namespace faba
