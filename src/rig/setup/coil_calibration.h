#pragma once
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "core/schema.h"

namespace faba {

/// Wiring and calibration of one coil: its output, current as a function of voltage, limits, and the input
/// that senses its current. One [[rig.coil]].
///
///   current = polarity * gain * (voltage - neutral),   or linear interpolation in the table.
struct WiredCoil {
  std::string channel = {};  ///< of the driver, in its notation
  double gain = 1;           ///< A/V
  double neutral = 0;  ///< V, voltage of zero current, such as 2.5 V for an amplifier with inputs of 0 to 5 V
  int polarity = 1;    ///< +1, or -1 if the coil is wired in reverse
  std::vector<Vec2> table = {};            ///< V and A, voltage increasing; in place of gain and neutral
  double least_volts = 0, most_volts = 5;  ///< V, output range
  double max_current = 0.5;                ///< A; the guard trips above it
  double max_rms = 0.5;                    ///< A, over the guard's thermal time
  std::string sense = {};                  ///< input that senses the current; empty for none
  double sense_gain = 1;                   ///< A/V
  double sense_neutral = 0;                ///< V, voltage of zero current
  static Schema<WiredCoil> schema();

  /// Voltage for a current in A, not clipped to the output range.
  double volts(double current) const;
  /// Current in A at a voltage.
  double current(double volts) const;
  /// Maximum current that the output can supply in both directions, A.
  double reach() const;
  double sensed(double volts) const { return sense_gain * (volts - sense_neutral); }
};

/// Outputs and inputs of all coils. Coils of one channel are wired together: the channel supplies the mean of
/// their requests, taking polarity into account.
class CoilWiring {
 public:
  explicit CoilWiring(std::vector<WiredCoil> coils);

  const std::vector<WiredCoil>& coils() const { return coils_; }
  const std::vector<std::string>& channels() const {
    return channels_;
  }  ///< without duplicates, in the order of the coils
  const std::vector<std::string>& senses() const { return senses_; }  ///< likewise
  /// Voltage of each channel for the currents of all coils, A, clipped to the output range.
  std::vector<double> volts(std::span<const double> currents) const;
  /// Voltage of zero current of each channel.
  std::vector<double> neutral() const;
  /// Currents of all coils, A, at these voltages of the channels.
  std::vector<double> currents(std::span<const double> volts) const;
  /// Sensed currents, A, in the order of the coils; NaN for coils without an input.
  std::vector<double> sensed(std::span<const double> volts) const;

 private:
  std::vector<WiredCoil> coils_;
  std::vector<std::string> channels_, senses_;
  std::vector<std::size_t> channel_of_, sense_of_;
};

}  // namespace faba
