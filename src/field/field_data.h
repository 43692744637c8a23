#pragma once
#include <array>
#include <string>
#include <vector>

#include "core/table.h"
#include "core/vec.h"

namespace faba {

/// A field as somebody measured or computed it: what was found at which points.
struct FieldData {
  std::string source;         ///< file name, for messages
  std::vector<Vec3> at;       ///< m
  std::vector<Vec3> b;        ///< T; components that are not given are 0
  std::array<bool, 3> given;  ///< which components of b are
  bool about_axis = false;    ///< x is the distance from an axis of symmetry, along z
};

/// What the columns of a table say: coordinates `x`, `y`, `z`, or `rho`, `z` about an axis, and the field's
/// components `bx`, `by`, `bz`, or `brho`, `bz`, each followed by its unit: `x_mm`, `bz_gauss`. Lengths in m,
/// cm, mm or um, fields in t, mt, ut, nt or gauss. Coordinates that are absent are 0. Throws Error(input)
/// naming file, line or column, and what is expected.
FieldData field_data(const Table& t);

}  // namespace faba
