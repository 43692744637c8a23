#pragma once
#include <array>
#include <cstddef>
#include <string>
#include <vector>

#include "study/quality/quality.h"

namespace faba {

/// A coil system fitted to a measured field: one gain, one shift and one added field for all coils.
struct FieldFit {
  struct Values {
    double gain = 1;
    std::array<double, 3> shift{}, offset{};  ///< m, T
  };
  std::size_t values = 0;  ///< measured
  Values best;
  Values standard_error;                  ///< NaN where nothing was fitted
  double t95 = 0;                         ///< half width of a 95 % interval in standard errors (Student)
  double rms = 0;                         ///< of the residuals, T
  double rms_field = 0;                   ///< of the measured values, T
  std::vector<std::string> undetermined;  ///< parameters that were kept: "shift x"
  std::vector<Warning> warnings;
};

}  // namespace faba
