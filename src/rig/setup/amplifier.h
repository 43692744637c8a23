#pragma once
#include <cstdint>
#include <span>
#include <string>
#include <vector>

#include "core/schema.h"

namespace faba {

/// Electronics of a simulated bench (theory C4, thesis 3.2): a D/A converter with finite resolution; an
/// amplifier with reference voltage and saturation; coils whose current lags, with different time constants
/// for rising and falling current (free-wheel diodes); and a relay that opens when its enable line times out.
/// One voltage per coil.
///
///   target = gain * (quantised voltage - reference), clipped at the saturation; zero while the relay is open
///   dI/dt  = (target - I) / rise_time, or / fall_time while |I| falls
class Amplifier {
 public:
  enum class Fault : std::uint32_t {
    none,
    stuck,  ///< the output does not change
    open,   ///< no current flows in the coil
    weak    ///< the current is halved
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
  /// Sets the voltages at time t, s; NaN leaves an output unchanged. `enable`: keeps the relay closed.
  void take(std::span<const double> volts, bool enable, double t);
  /// The currents at time t, A; t must not decrease.
  const std::vector<double>& at(double t);
  /// Voltages of the sense inputs, V: reference + current / gain.
  std::vector<double> sensed() const;
  bool enabled() const { return enabled_; }  ///< the relay is closed

 private:
  double target(std::size_t k, double volts) const;
  void advance(double t);

  Params p_;
  std::vector<double> current_, target_;                ///< A
  double t_ = 0, last_enable_ = 0, first_command_ = 0;  ///< s
  bool enabled_ = false, started_ = false;
};

}  // namespace faba
