#pragma once
#include <functional>
#include <optional>
#include <vector>

#include "core/archive.h"
#include "core/schema.h"
#include "core/signals.h"

namespace faba {

/// What the loop allows between a controller and the coils, whatever the controller says.
///
/// `max_slew` holds for currents that answer a picture. When the picture is older than `max_frame_age`,
/// nobody knows what the swarm does, and all currents are zero at once: a slow way down would go on steering
/// by what was seen long ago. The guard of a bench, whose own slew rule has the same limit, lets all-zero
/// pass at any moment (rig/setup/coil_guard.h), and takes the current away at once itself. The first current
/// after that is again within `max_slew` of zero.
class Limits {
 public:
  struct Params {
    double max_current = 2;
    std::optional<double> max_slew;
    double max_frame_age = 1;
  };
  static Schema<Params> schema();
  /// `most`: the largest current of each coil, A, one per coil; when empty, there are as many coils as a
  /// command has currents, and they have the common limit alone. `wired`, when given: brings currents to what
  /// flows in coils that hang on one output.
  explicit Limits(const Params& p, std::vector<double> most = {},
                  std::function<void(std::vector<double>&)> wired = {})
      : p_(p), most_(std::move(most)), wired_(std::move(wired)) {}

  /// Clips to the current limits, and the change since the last command to the slew limit; what is not finite
  /// counts as zero, which is approached within the slew limit. All zero at once when the frame is older than
  /// allowed or its age is not a number. `dt`, s: since the last command. Returns whether anything was
  /// changed. Throws Error(usage) for another number of currents than there are coils.
  bool apply(Command& c, double dt, double frame_age);
  /// The coils had no current for a while: changes are reckoned from there.
  void coils_off() { last_.assign(last_.size(), 0.0); }
  void archive(Archive& a) { a& last_; }

 private:
  double limited(std::size_t coil, double current, double dt) const;  ///< A

  Params p_;
  std::vector<double> most_;  ///< A
  std::function<void(std::vector<double>&)> wired_;
  std::vector<double> last_;  ///< A, what was let through last
};

}  // namespace faba
