#pragma once
#include <string>
#include <vector>

namespace faba::drawing {

/// Values of a plot in the attributes of its drawing, so that a page can show and export numbers. A column is
/// the text "offset step order codes": value = offset + n * step with integers n. The codes are those of the
/// differences of n (order 1 or 2; order 0: of n) as base-64 variable-length quantities, as in source maps;
/// "-" is a missing value. The offset and the step are exact decimals.

/// A column with a step of at most 1e-6 of the largest value, or 1e-9 for columns of at most 100 values, but
/// not finer than the values need. NaN: missing.
std::string data_column(const std::vector<double>& values);

/// A column of values `all[i]` for the indices `kept`; -1: missing. Evenly spaced values, such as times of
/// frames, have their spacing as step.
std::string data_column(const std::vector<double>& all, const std::vector<int>& kept);

/// Attributes `data-NAME` with this column.
std::string data_attribute(const char* name, const std::string& column);

}  // namespace faba::drawing
