#pragma once
#include <string>
#include <string_view>
#include <vector>

namespace faba {

/// Escapes text for element content and quoted attributes of XML and HTML: & < > " ' become entities; control
/// characters other than tab and line ends, and bytes that are not valid UTF-8, become U+FFFD.
std::string escape_markup(std::string_view text);

/// A number with three significant digits, without decimals from 100, with the minus sign U+2212, and with an
/// exponent below 0.001 and from 1e6; an en dash for non-finite values.
std::string three_digits(double value);

/// A power of ten as text: "10³", "10⁻⁶".
std::string power_of_ten(int exponent);

/// A row of an HTML table: with `tag` "td" the first cell is the heading of the row, the others are data;
/// with "th" all are headings of columns, for a <thead>. The cells must be escaped already.
std::string table_row(const std::vector<std::string>& cells, const char* tag);

}  // namespace faba
