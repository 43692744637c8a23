#pragma once
#include <string>
#include <string_view>
#include <vector>

namespace faba {

/// Text made safe for XML and HTML, in element content and in quoted attributes: & < > " ' become entities;
/// control characters other than tab and line ends, and bytes that are not UTF-8, become U+FFFD.
std::string escape_markup(std::string_view text);

/// A number as one writes it in a sentence: three significant digits, whole when 100 or more, a true minus
/// sign, an exponent only below 0.001 and from a million on; an en dash for what is not finite.
std::string three_digits(double value);

/// A power of ten for humans: "10³", "10⁻⁶".
std::string power_of_ten(int exponent);

/// A row of an HTML table: the first cell is its heading, the others are elements of `tag` ("td" or "th").
/// Cells are markup already.
std::string table_row(const std::vector<std::string>& cells, const char* tag);

}  // namespace faba
