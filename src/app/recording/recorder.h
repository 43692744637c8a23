#pragma once
#include <condition_variable>
#include <deque>
#include <exception>
#include <mutex>
#include <thread>

#include "app/loop/loop.h"

namespace faba {

/// Passes every control cycle to its sinks in a separate thread, so that a real-time loop does not wait for
/// the disk. No data are lost: if the sinks are `kMost` cycles behind, the loop waits.
class Recorder final : public Sink {
 public:
  static constexpr std::size_t kMost = 300;  // 90 MB of 640 x 480 px

  /// `sinks` must outlive it and must not be called by others before finish().
  explicit Recorder(std::vector<Sink*> sinks);
  ~Recorder() override;
  /// Throws the exception that a sink threw in an earlier cycle.
  void take(const Tick& t) override;
  /// Returns when the sinks have received all cycles. Throws the exception of a sink.
  void finish();
  std::size_t most_behind() const { return most_behind_; }  ///< maximum backlog, cycles

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
