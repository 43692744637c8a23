#pragma once
#include <optional>
#include <string>
#include <vector>

#include "core/schema.h"

namespace faba {

/// A number of a scenario that is not known.
struct FreeParameter {
  std::string path;  ///< "swarm[0].model.max_speed"
  std::string unit;  ///< of the numbers below, as units.h knows it; "" for a pure number
  bool whole = false;
  Role role = Role::none;
  bool low_is_least = false, high_is_most = false;  ///< nothing lies beyond that end of the range
  double low = 0, high = 1;
  /// Of the scale on which all values are taken for equally likely: 0 a linear one; else it is stretched, so
  /// that the middle of it lies at the part's own default (bounds that come from a schema are wide).
  double stretch = 0;
  /// A normal law in place of an even one: what a calibration says.
  struct Known {
    double mean = 0, sd = 0;
  };
  std::optional<Known> known = {};

  std::string name() const;  ///< the last word of its path: "max_speed"
  /// The unit that people use for it, "um/s" for "m/s", and how many of them one of `unit` is.
  std::string shown_unit() const;
  double shown(double value) const;
  /// The value at share u of the range, 0 to 1, and back.
  double value(double u) const;
  double share(double value) const;
  /// As it stands in a scenario: with unit, or whole.
  Json json(double u) const;
  /// Logarithm of the prior density at share u, up to a constant.
  double log_prior(double u) const;
};

/// Reads the table or list `free` of a model: paths, or paths with `[low, high]`, `{ mean, sd }` or true.
/// Bounds that are not given come from the schema of what stands at the path in `scenario`, and none may go
/// beyond it. Throws Error(usage) for paths that do not exist, values that are no numbers, and bounds that
/// make no range.
std::vector<FreeParameter> read_free_parameters(const Node& free, const Json& scenario);

/// A value of the parameter as a study gives it: a number, or a quantity in its unit. Throws Error(usage) for
/// one that is neither, or beyond its range.
double read_value(const Node& n, const FreeParameter& p);

/// The number at a path of a scenario, in SI: what stands there, else its default. Empty when there is
/// neither.
std::optional<double> scenario_number(const std::string& path, const Json& scenario);

}  // namespace faba
