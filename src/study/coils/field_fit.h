#pragma once
#include <array>
#include <cstddef>
#include <filesystem>
#include <string>

namespace faba {

/// A rig brought to a measured field: one factor on all coils, one shift of all coils, one added field.
struct FieldFit {
  struct Values {
    double gain = 1;
    std::array<double, 3> shift{}, offset{};  ///< m, T
  };
  std::size_t values = 0;  ///< measured
  Values best;
  Values standard_error;  ///< NaN where nothing was fitted
  double rms = 0;         ///< T, of what the fit leaves over
  double rms_field = 0;   ///< T, of the measured values
  std::string note;       ///< empty when all is well
};

/// Fits with the coils' own currents to measured values (FieldData) by least squares; the shift is along z
/// only for data about an axis. Standard errors take the errors of measurement as equal and independent.
/// Unless empty, `out` is written as the rig that fits, `picture` as SVG with what is left over. Throws
/// Error(usage) for a rig without current, Error(input) for data that are wrong, too few, or do not tell.
FieldFit field_fit(const std::filesystem::path& rig, const std::filesystem::path& measured,
                   const std::filesystem::path& out, const std::filesystem::path& picture);

}  // namespace faba
