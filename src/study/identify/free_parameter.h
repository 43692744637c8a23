#pragma once
#include <optional>
#include <string>
#include <vector>

#include "core/schema.h"

namespace faba {

/// An unknown number of a scenario that is to be estimated.
struct FreeParameter {
  std::string path;  ///< "swarm[0].model.max_speed"
  std::string unit;  ///< unit of the numbers below, as in units.h; "" for a dimensionless number
  bool integer = false;
  Role role = Role::none;
  bool low_is_limit = false, high_is_limit = false;  ///< the range ends at the limit of the parameter itself
  double low = 0, high = 1;
  /// Scale on which the prior is uniform: 0 linear; > 0 exponential, so that the middle of the range lies at
  /// the default of the part (the bounds of a schema are wide); < 0 exponential with values near `high`.
  double stretch = 0;
  /// Normal prior, for example from a calibration, instead of a uniform one.
  struct NormalPrior {
    double mean = 0, sd = 0;
  };
  std::optional<NormalPrior> normal_prior = {};
  /// Of a nuisance parameter, which the program frees by default: the source of its prior. Empty for the
  /// parameters of the study.
  std::string nuisance_source = {};
  bool nuisance() const { return !nuisance_source.empty(); }

  std::string name() const;  ///< last key of the path: "max_speed"
  /// Unit for display ("um/s" for "m/s"), and a value converted to that unit.
  std::string shown_unit() const;
  double shown(double value) const;
  /// Value at fraction u of the range, 0 to 1, and the inverse.
  double value(double u) const;
  double fraction(double value) const;
  /// Value at fraction u in the form of a scenario: a quantity with unit, a number or an integer.
  Json json(double u) const;
  /// Logarithm of the prior density at fraction u, up to a constant.
  double log_prior(double u) const;
};

/// Reads the table or list `free` of a model: paths, or paths with `[low, high]`, `{ mean, sd }` or true.
/// The default bounds are those of the schema at the path in `scenario`; given bounds must lie within them.
/// Throws Error(usage) for unknown paths, values that are not numbers, and invalid bounds.
std::vector<FreeParameter> read_free_parameters(const Node& free, const Json& scenario);

/// Reads a value of the parameter: a number, or a quantity in its unit. Throws Error(usage) for other values
/// and for values out of range.
double read_value(const Node& n, const FreeParameter& p);

/// The number at a path of a scenario, in SI units: its value, else its default. Empty when there is neither.
std::optional<double> scenario_number(const std::string& path, const Json& scenario);

}  // namespace faba
