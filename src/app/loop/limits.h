#pragma once
#include <functional>
#include <optional>
#include <vector>

#include "core/archive.h"
#include "core/schema.h"
#include "core/signals.h"

namespace faba {

/// Limits of the commands between controller and coils.
///
/// `max_slew` limits commands that respond to a picture. If the picture is older than `max_frame_age`, the
/// state of the swarm is unknown and all currents are set to zero immediately; a slow decrease would continue
/// to steer by an old picture. The guard of a bench has the same slew limit, but permits zero currents at any
/// time (rig/setup/coil_guard.h), and itself switches off immediately. The first current after that is again
/// within `max_slew` of zero.
class Limits {
 public:
  struct Params {
    double max_current = 2;
    std::optional<double> max_slew;
    double max_frame_age = 1;
  };
  static Schema<Params> schema();
  /// `max_currents`: maximum current of each coil, A; if empty, the number of coils is that of the currents
  /// of a command, and only the common limit applies. `wired`, if given: replaces the currents by those that
  /// flow in coils that share an output.
  explicit Limits(const Params& p, std::vector<double> max_currents = {},
                  std::function<void(std::vector<double>&)> wired = {})
      : p_(p), max_currents_(std::move(max_currents)), wired_(std::move(wired)) {}

  /// Clips to the current limits, and the change since the last command to the slew limit; non-finite values
  /// count as zero, which is approached within the slew limit. Sets all currents to zero immediately if the
  /// frame age is above the maximum or NaN. `dt`: time since the last command, s. Returns whether the command
  /// was changed. Throws Error(usage) if the number of currents is not the number of coils.
  bool apply(Command& c, double dt, double frame_age);
  /// The coils were de-energised: the slew limit applies from zero.
  void coils_off() { last_.assign(last_.size(), 0.0); }
  void archive(Archive& a) { a& last_; }

 private:
  double limited(std::size_t coil, double current, double dt) const;  ///< A

  Params p_;
  std::vector<double> max_currents_;  ///< A
  std::function<void(std::vector<double>&)> wired_;
  std::vector<double> last_;  ///< A, last command after the limits
};

}  // namespace faba
