#pragma once
#include <functional>

#include "app/run/simulation.h"

namespace faba {

/// A run without end that somebody steers by hand: parts are exchanged as it goes on, and every exchange is
/// kept. It records nothing; recorded() is a scenario that does all of it again, to the same bits, and a
/// Session makes the recording from that. Not thread-safe: one thread runs it and calls everything below.
class LiveRun {
 public:
  /// Throws Error(usage) as read_scenario() and Simulation do. Events in `d` happen, too.
  LiveRun(const Document& d, std::uint64_t seed, const Parts& parts, Pool& pool);

  /// Runs until `keep_running`, asked after every frame, says no. Coils are made safe then.
  void run(const std::function<bool()>& keep_running);
  /// Exchanges the parts that `event` names (the keys of an [[event]] without `frame`) before the next
  /// frame. Throws Error(usage), having changed nothing.
  void exchange(const Json& event);

  std::uint64_t frame() const { return simulation_->loop().next; }  ///< frames made so far
  Simulation& simulation() { return *simulation_; }
  const Scenario& scenario() const { return now_; }  ///< as it stands now, without events
  std::uint64_t seed() const { return seed_; }
  std::size_t exchanges() const { return given_.size(); }  ///< made by exchange()
  /// The whole scenario with seed, events, and the duration of the run until now.
  Scenario recorded() const;
  /// What the manifest of a run of recorded() will say.
  std::string state_hash() const;

 private:
  const Parts& parts_;
  Scenario began_, now_;
  std::size_t passed_ = 0;    ///< events of began_ that now_ knows of
  std::vector<Event> given_;  ///< by exchange()
  std::uint64_t seed_;
  std::unique_ptr<Simulation> simulation_;
};

}  // namespace faba
