#pragma once
#include <functional>
#include <optional>
#include <vector>

#include "core/archive.h"
#include "core/schema.h"
#include "core/signals.h"

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
  /// `most`: the largest current of each coil, A, one per coil; when empty, there are as many coils as a
  /// command has currents, and they have the common limit alone. `wired`, when given: brings currents to what
  /// flows in coils that hang on one output.
  explicit Limits(const Params& p, std::vector<double> most = {},
                  std::function<void(std::vector<double>&)> wired = {})
      : p_(p), most_(std::move(most)), wired_(std::move(wired)) {}

  /// Clips to the current and slew limits; not-a-number becomes zero; all zero when the frame is older than
  /// allowed. Returns whether anything was changed. Throws Error(usage) for another number of currents than
  /// there are coils.
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

}  // namespace faba
