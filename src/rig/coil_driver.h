#pragma once
#include <memory>
#include <span>
#include <string>
#include <vector>

#include "core/registry.h"

namespace faba {

/// How a call to a device ended: well, or why not, in one line that names the device.
struct Status {
  std::string trouble;  ///< empty: well
  explicit operator bool() const { return trouble.empty(); }
};

/// A device with one analogue output per channel, in the guard's process and nowhere else. Made, it puts out
/// nothing new; made again and again it must do no harm. Only one thread calls it.
class CoilDriver {
 public:
  virtual ~CoilDriver() = default;
  /// Puts out these voltages, V, one per channel. `enable`: the line that lets current flow is kept alive;
  /// without, it drops at once. Called every beat() at least, whether anything changed or not.
  virtual Status write(std::span<const double> volts, bool enable) = 0;
  /// Reads the inputs, V, one per sense channel.
  virtual Status sense(std::span<double> volts) = 0;
  /// Why current could go on flowing when this computer dies; empty when the device takes it away by itself.
  virtual std::string unsafe() const = 0;
  /// Longest time between two calls of write(), s, by which the device knows that somebody is there.
  virtual double beat() const { return 0.01; }
};

/// What a driver is made for.
struct DriverContext {
  std::vector<std::string> channels, senses;  ///< names of outputs and inputs, in the driver's own words
  std::vector<double> least_volts, most_volts, neutral;  ///< V, of each output
};
using CoilDriverRegistry = Registry<CoilDriver, DriverContext>;

/// The drivers that come with the program, for the guard of the coils, which is linked with them alone.
CoilDriverRegistry builtin_coil_drivers();

}  // namespace faba
