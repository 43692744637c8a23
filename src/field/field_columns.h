#pragma once
#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace faba {

/// A unit of length or of magnetic field.
struct FieldUnit {
  bool of_field = false;  ///< else of length
  double in_si = 1;
};
/// Reads m, cm, mm, um, inch, T, mT, uT, nT, G, gauss, mG, kG; the case has no meaning. Empty for other text.
std::optional<FieldUnit> field_unit(std::string_view text);

/// Meaning of a column of a table of a field.
struct FieldColumn {
  /// x, y, z, rho; bx, by, bz, brho; b for the component along the only coordinate.
  std::string quantity;
  std::string unit_text;  ///< as in the header; empty: none is given
  std::optional<FieldUnit> unit;
  bool is_field() const { return quantity[0] == 'b'; }
};
/// Reads the header of a column: "z_mm", "z (cm)", "B [G]", "Bz / mT", "br uT", or a quantity without a unit.
/// Empty for other text, such as "time (s)".
std::optional<FieldColumn> field_column(std::string_view header);

}  // namespace faba
