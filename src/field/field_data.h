#pragma once
#include <array>
#include <string>
#include <vector>

#include "core/table.h"
#include "core/vec.h"

namespace faba {

/// A measured or computed field: vectors at points.
struct FieldData {
  std::string source;         ///< file name, for messages
  std::vector<Vec3> at;       ///< m
  std::vector<Vec3> b;        ///< T; components that are not given are 0
  std::array<bool, 3> given;  ///< which components of b are given
  bool about_axis = false;    ///< x is the distance from an axis of symmetry along z
};

/// Reads a field from a table with the coordinates `x`, `y`, `z`, or `rho`, `z` about an axis, and the
/// components `bx`, `by`, `bz`, or `brho`, `bz`; or with one coordinate and `b`, the component along it. The
/// names have units, see field_column(). Missing coordinates are 0. Throws Error(input) with the file, the
/// line or column and the expected format.
FieldData field_data(const Table& t);

}  // namespace faba
