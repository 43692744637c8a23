#pragma once
#include <cstdint>
#include <filesystem>
#include <functional>

#include "app/files/field_table.h"
#include "study/coils/field_fit_result.h"

namespace faba {

struct FieldFitOptions {
  FieldTableFormat format = {};  ///< of the table
  std::filesystem::path out = {},
                        picture = {};  ///< coil system (.toml) and residuals (.svg); empty: not written
  /// Called after each evaluation of the field at all points with their number so far; may be empty.
  std::function<void(std::uint64_t evaluations)> evaluated = {};
};

/// Least-squares fit to measured values (FieldData) with the default currents of the coils; for data about an
/// axis the shift is along z only. Standard errors assume equal and independent measurement errors. Throws
/// Error(usage) for a coil system without current, Error(input) for data that are invalid or too few.
/// Parameters that the data do not determine keep their values in the coil system.
FieldFit field_fit(const std::filesystem::path& rig, const std::filesystem::path& measured,
                   const FieldFitOptions& options = {});

}  // namespace faba
