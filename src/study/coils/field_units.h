#pragma once
#include <optional>
#include <string>

#include "field/field.h"
#include "field/field_data.h"

namespace faba {

/// The units in which the coil system describes a table, where those of the table are probably wrong.
struct LikelyUnits {
  std::string change;    ///< "the lengths are 1000 times smaller, as of mm read as m"
  std::string evidence;  ///< "the gain is 0.93 if ..."
};
/// Whether another unit of the field explains a gain far from 1. Empty if none does.
std::optional<LikelyUnits> likely_field_unit(double gain);
/// Whether the coil system describes the table only with other units of its lengths or its field. `residual`:
/// of the fit in the units of the table, as a fraction of the field; infinite without a fit.
std::optional<LikelyUnits> likely_units(const Field& field, const FieldData& data, std::optional<Vec3> centre,
                                        double residual);

}  // namespace faba
