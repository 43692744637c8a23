#pragma once
#include <cstdint>
#include <span>
#include <string>
#include <vector>

#include "core/schema.h"

namespace faba {

/// The electronics of one rig (theory C4, thesis 3.2): a converter of few bits, an amplifier that compares
/// its voltage with a reference, is saturated, and drives coils whose current lags; free-wheel diodes make it
/// fall in another time than it rises; a relay that opens when nobody keeps its line alive. One voltage per
/// coil.
///
///   target = gain * (quantised voltage - reference), at most the saturation; zero while the relay is open
///   dI/dt  = (target - I) / rise_time, or / fall_time while |I| falls
class Amplifier {
 public:
  enum class Fault : std::uint32_t {
    none,
    stuck,  ///< the output stays where it is, whatever is asked for
    open,   ///< no current flows in the coil
    weak    ///< half of the current flows
  };
  struct Params {
    double reference = 2.5;
    double gain = 0.2;
    double saturation = 0.45;
    double rise_time = 2e-3, fall_time = 4e-3;
    int bits = 12;
    double least_volts = 0, most_volts = 5;
    double enable_time = 0.07;
    bool enable_line = true;
    Fault fault = Fault::none;
    double fault_after = 0;
  };
  static Schema<Params> schema();

  Amplifier(const Params& p, std::size_t coils);
  /// Takes voltages at time t, s; one that is not a number stays. `enable`: the line of the relay was kept
  /// alive.
  void take(std::span<const double> volts, bool enable, double t);
  /// The currents at time t, A; t never goes back.
  const std::vector<double>& at(double t);
  /// What the inputs would read, V: as far from the reference as the current says.
  std::vector<double> sensed() const;
  bool enabled() const { return enabled_; }  ///< the relay is closed

 private:
  double target(std::size_t k, double volts) const;
  void advance(double t);

  Params p_;
  std::vector<double> current_, target_;  ///< A
  double t_ = 0, alive_ = 0, began_ = 0;  ///< s
  bool enabled_ = false, begun_ = false;
};

}  // namespace faba
