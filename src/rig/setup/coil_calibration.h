#pragma once
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "core/schema.h"

namespace faba {

/// One coil as it is wired: the output that drives it, how its current follows the voltage there, what it
/// bears, and the input that tells its current. One [[rig.coil]].
///
///   current = polarity * gain * (voltage - neutral),   or by the table of measured pairs, between which it
///   is straight.
struct WiredCoil {
  std::string channel = {};  ///< of the driver, in its own words
  double gain = 1;           ///< A/V
  double neutral = 0;  ///< V, at which no current flows: half of the range of an amplifier between 0 and 5 V
  int polarity = 1;    ///< +1, or -1 when the coil is wired the other way round
  std::vector<Vec2> table = {};            ///< V and A, voltage rising; in place of gain and neutral
  double least_volts = 0, most_volts = 5;  ///< V, what the output gives
  double max_current = 0.5;                ///< A, beyond which the guard faults
  double max_rms = 0.5;                    ///< A, over the guard's thermal time
  std::string sense = {};                  ///< input that tells the current; empty for none
  double sense_gain = 1;                   ///< A/V
  double sense_neutral = 0;                ///< V, at no current
  static Schema<WiredCoil> schema();

  /// The voltage for a current in A; not clipped to what the output gives.
  double volts(double current) const;
  /// The current in A at a voltage.
  double current(double volts) const;
  /// Largest current of both directions that the output can give, A.
  double reach() const;
  double sensed(double volts) const { return sense_gain * (volts - sense_neutral); }
};

/// The outputs and inputs of all coils. Coils of one channel are wired together: it gives the mean of what
/// they ask for, each counted with its polarity.
class CoilWiring {
 public:
  explicit CoilWiring(std::vector<WiredCoil> coils);

  const std::vector<WiredCoil>& coils() const { return coils_; }
  const std::vector<std::string>& channels() const {
    return channels_;
  }                                                                   ///< each once, in order of the coils
  const std::vector<std::string>& senses() const { return senses_; }  ///< likewise
  /// Volts of each channel for the currents of all coils, A, within what the output gives.
  std::vector<double> volts(std::span<const double> currents) const;
  /// Volts at which no current flows, of each channel.
  std::vector<double> neutral() const;
  /// The currents of all coils, A, that flow at these voltages of the channels.
  std::vector<double> currents(std::span<const double> volts) const;
  /// The currents as the inputs tell them, A, in the order of the coils; not a number where none does.
  std::vector<double> sensed(std::span<const double> volts) const;

 private:
  std::vector<WiredCoil> coils_;
  std::vector<std::string> channels_, senses_;
  std::vector<std::size_t> channel_of_, sense_of_;
};

}  // namespace faba
