#pragma once
#include <array>
#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <functional>
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
  double rms = 0;                         ///< of the residuals, T
  double rms_field = 0;                   ///< of the measured values, T
  std::vector<std::string> undetermined;  ///< parameters that were not fitted: "shift x"
  std::vector<Warning> warnings;
};

/// Least-squares fit to measured values (FieldData) with the default currents of the coils; for data about an
/// axis the shift is along z only. Standard errors assume equal and independent measurement errors. Unless
/// empty, `out` is written as the fitted coil system, `picture` as SVG with the residuals. `evaluated` is
/// called after each evaluation of the field at all points with their number so far; may be empty. Throws
/// Error(usage) for a coil system without current, Error(input) for data that are invalid or too few.
/// Parameters that the data do not determine keep their values in the coil system.
FieldFit field_fit(const std::filesystem::path& rig, const std::filesystem::path& measured,
                   const std::filesystem::path& out, const std::filesystem::path& picture,
                   const std::function<void(std::uint64_t evaluations)>& evaluated = {});

}  // namespace faba
