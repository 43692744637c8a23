#pragma once
#include <optional>
#include <vector>

#include "study/coils/field_model.h"
#include "study/quality/quality.h"

namespace faba {

/// A fitted table of a field.
struct FittedField {
  const Field& field;
  const FieldData& data;
  std::optional<Vec3> centre;  ///< of the coil, m, if there is only one
  const FieldModel& model;
  const DeterminedFit& fit;
};
/// The violated assumptions of a fit: units, residual, direction, gain, parameters that are not determined,
/// readings at the end of the range of the probe, residuals that depend on their neighbours, the size of the
/// coil, the direction of the axis. Adds "size" to the parameters that are not determined, if the size of the
/// coil is not.
std::vector<Warning> field_warnings(const FittedField& fitted, FieldFit& result);

}  // namespace faba
