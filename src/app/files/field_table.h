#pragma once
#include <filesystem>
#include <string>
#include <vector>

#include "core/table.h"

namespace faba {

/// Names and units of the columns of a table of a field, for a file that does not state them.
struct FieldTableFormat {
  /// One per column of the file: x, y, z, rho, bx, by, bz, brho, or b for the component along the only
  /// coordinate; "-" for a column that is not used. Empty: from the header.
  std::vector<std::string> columns = {};
  /// One per used column, or one of length and one of field. Empty: from the header.
  std::vector<std::string> units = {};
  bool empty() const { return columns.empty() && units.empty(); }
};

/// Reads a measured field from a text file as instruments and spreadsheets write it: columns separated by
/// tabs, semicolons, commas or spaces; decimal points, or decimal commas unless commas separate the columns;
/// lines above the header without numbers; comments that start with '#', '%', '!' or "//", of which the last
/// one above the data may be the header; units in the header (field_column()) or in the line below it. The
/// result has the used columns only, named like "z (cm)"; others may contain text. Throws Error(input,
/// "file:line") for a missing or invalid value and a line with more or fewer fields, Error(input) for a file
/// without names or units, with the options that state them, and Error(usage) for a format that does not
/// match the file.
Table read_field_table(const std::filesystem::path& file, const FieldTableFormat& format = {});

}  // namespace faba
