#pragma once
#include <functional>
#include <vector>

#include "control/controller.h"
#include "core/schema.h"
#include "rig/rig.h"

namespace faba {

/// What the loop allows between a controller and the coils, whatever the controller says.
class Limits {
 public:
  struct Params {
    double max_current = 2;
    std::optional<double> max_slew;
    double max_frame_age = 1;
  };
  static Schema<Params> schema();
  /// `most`: the largest current of each coil, A; coils beyond its length have the common limit alone.
  /// `wired`, when given: brings currents to what flows in coils that hang on one output.
  explicit Limits(const Params& p, std::vector<double> most = {},
                  std::function<void(std::vector<double>&)> wired = {})
      : p_(p), most_(std::move(most)), wired_(std::move(wired)) {}

  /// Clips to the current and slew limits; not-a-number becomes zero; all zero when the frame is older than
  /// allowed. Returns whether anything was changed.
  bool apply(Command& c, double dt, double frame_age);
  /// The coils had no current for a while: changes are reckoned from there.
  void rested() { last_.assign(last_.size(), 0.0); }
  void archive(Archive& a) { a& last_; }

 private:
  Params p_;
  std::vector<double> most_;  ///< A
  std::function<void(std::vector<double>&)> wired_;
  std::vector<double> last_;  ///< A, what was let through last
};

/// One turn of the loop, as sinks see it.
struct Tick {
  std::uint64_t index;
  const Observation& seen;
  const Estimate& estimate;
  const Target& target;
  const Command& command;  ///< after the limits
  bool limited;            ///< the limits changed it
};

/// Somebody who records.
class Sink {
 public:
  virtual ~Sink() = default;
  virtual void take(const Tick& t) = 0;
};

/// The parts of a closed loop. They outlive it, or are exchanged between two turns.
struct Loop {
  Rig& rig;
  Estimator* estimator;
  Reference* reference;
  Controller* controller;
  Limits& limits;
  double frame_period = 0;  ///< s; stands for the time step in the very first turn
  std::vector<Sink*> sinks;
  std::function<void()> between;  ///< called before every turn, when parts may be exchanged

  std::uint64_t next = 0;  ///< index of the next turn; a resumed loop starts where it was
  double last_t = 0;       ///< time stamp of the frame before, s
  Command last;            ///< written in the turn before
};

/// The only closed loop in the program; simulation, replay and hardware differ only in the rig:
/// guard -> read -> estimate -> control -> limit -> write -> sinks. Runs until turn `end`, until the rig has
/// no more frames, or until `go_on` (asked after every turn) says no. The rig is made safe on every way out.
void run(Loop& loop, std::uint64_t end, const std::function<bool()>& go_on);

}  // namespace faba
