#pragma once
#include <memory>
#include <span>
#include <string>
#include <vector>

#include "core/registry.h"

namespace faba {

/// Result of a call to a device.
struct Status {
  std::string error;  ///< error in one line that names the device; empty: success
  explicit operator bool() const { return error.empty(); }
};

/// A device with one analogue output per channel, used only in the guard's process. Construction, also
/// repeated construction, must not energise a coil. Only one thread calls it.
class CoilDriver {
 public:
  virtual ~CoilDriver() = default;
  /// Sets the outputs, V, one per channel. `enable`: keeps the enable line active; false drops it at once.
  /// Called at least every write_period(), also without a change.
  virtual Status write(std::span<const double> volts, bool enable) = 0;
  /// Reads the inputs, V, one per sense channel.
  virtual Status sense(std::span<double> volts) = 0;
  /// Why current could continue to flow if this computer fails; empty if the device de-energises by itself.
  virtual std::string unsafe() const = 0;
  /// Maximum time between two calls of write(), s: the device's heartbeat.
  virtual double write_period() const { return 0.01; }
};

/// Context for the construction of a driver.
struct DriverContext {
  std::vector<std::string> channels, senses;  ///< names of outputs and inputs, in the driver's notation
  std::vector<double> least_volts, most_volts, neutral;  ///< V, of each output
};
using CoilDriverRegistry = Registry<CoilDriver, DriverContext>;

/// The built-in drivers; the guard's program is linked with these only.
CoilDriverRegistry builtin_coil_drivers();

}  // namespace faba
