#pragma once
#include <functional>

#include "app/run/simulation.h"

namespace faba {

/// An interactive run without end: parts can be exchanged while it runs, and every exchange is stored. It
/// records nothing. recorded() is a scenario that repeats the run bit by bit; a Session creates the recording
/// from it. Not thread-safe: one thread must call run() and all other functions.
class LiveRun {
 public:
  /// Throws Error(usage) as read_scenario() and Simulation do. Events in `d` are applied, too.
  LiveRun(const Document& d, std::uint64_t seed, const Parts& parts, Pool& pool);

  /// Runs until `keep_running`, called after every frame, returns false; then calls Rig::safe().
  void run(const std::function<bool()>& keep_running);
  /// Exchanges the parts that `event` names (the keys of an [[event]] without `frame`) before the next frame.
  /// On Error(usage) nothing has been changed.
  void exchange(const Json& event);

  std::uint64_t frame() const { return simulation_->loop().next; }  ///< number of frames so far
  Simulation& simulation() { return *simulation_; }
  const Simulation& simulation() const { return *simulation_; }
  const Scenario& scenario() const { return now_; }  ///< with the current parts, without events
  std::uint64_t seed() const { return seed_; }
  std::size_t exchanges() const { return given_.size(); }  ///< number of stored exchanges
  /// The complete scenario with seed, events, and the duration of the run so far.
  Scenario recorded() const;
  /// State hash in the manifest of a run of recorded().
  std::string state_hash() const;

 private:
  const Parts& parts_;
  Scenario began_, now_;
  std::size_t passed_ = 0;    ///< number of events of began_ that are applied to now_
  std::vector<Event> given_;  ///< by exchange()
  std::uint64_t seed_;
  std::unique_ptr<Simulation> simulation_;
};

}  // namespace faba
