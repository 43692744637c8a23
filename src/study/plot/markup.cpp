#include "study/plot/markup.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>

#include <fmt/format.h>

namespace faba {
namespace {

/// Length of the well-formed UTF-8 sequence at the start of `s`; 0 if it is not well-formed. Table 3-7 of the
/// Unicode standard.
std::size_t sequence_length(std::string_view s) {
  const auto byte = [&](std::size_t i) { return i < s.size() ? static_cast<unsigned char>(s[i]) : 0U; };
  const unsigned first = byte(0);
  if (first < 0x80) return 1;
  const std::size_t length = first < 0xC2 ? 0 : first < 0xE0 ? 2 : first < 0xF0 ? 3 : first < 0xF5 ? 4 : 0;
  const unsigned lowest = first == 0xE0 ? 0xA0 : first == 0xF0 ? 0x90 : 0x80;
  const unsigned highest = first == 0xED ? 0x9F : first == 0xF4 ? 0x8F : 0xBF;
  for (std::size_t i = 1; i < length; ++i) {
    if (byte(i) < (i == 1 ? lowest : 0x80) || byte(i) > (i == 1 ? highest : 0xBF)) return 0;
  }
  return length;
}

constexpr std::string_view kReplacement = "\xEF\xBF\xBD", kMinus = "\xE2\x88\x92";

}  // namespace

std::string escape_markup(std::string_view text) {
  std::string out;
  out.reserve(text.size());
  while (!text.empty()) {
    const std::size_t length = sequence_length(text);
    const char c = text.front();
    if (c == '&')
      out += "&amp;";
    else if (c == '<')
      out += "&lt;";
    else if (c == '>')
      out += "&gt;";
    else if (c == '"')
      out += "&quot;";
    else if (c == '\'')
      out += "&#39;";
    else if (length == 0 || c == '\x7F' || (length == 1 && c < ' ' && c != '\n' && c != '\t' && c != '\r')) {
      out += kReplacement;
    } else {
      out += text.substr(0, length);
    }
    text.remove_prefix(std::max<std::size_t>(length, 1));
  }
  return out;
}

std::string three_digits(double value) {
  if (!std::isfinite(value)) return "\u2013";
  if (value == 0) return "0";
  const double size = std::abs(value);
  std::string digits = fmt::format("{:.2e}", size);  // the exponent of the rounded number
  const auto e = digits.find('e');
  const int exponent = std::stoi(digits.substr(e + 1));
  if (exponent < -3 || exponent >= 6)
    digits = fmt::format("{}\u00A0\u00D7\u00A0{}", digits.substr(0, e), power_of_ten(exponent));
  else
    digits = fmt::format("{:.{}f}", size, std::max(0, 2 - exponent));
  return value < 0 ? std::string(kMinus) + digits : digits;
}

std::string power_of_ten(int exponent) {
  constexpr std::array<std::string_view, 10> kRaised{"⁰", "¹", "²", "³", "⁴", "⁵", "⁶", "⁷", "⁸", "⁹"};
  std::string out = "10";
  for (const char c : std::to_string(exponent)) out += c == '-' ? "⁻" : kRaised[std::size_t(c - '0')];
  return out;
}

std::string table_row(const std::vector<std::string>& cells, const char* tag) {
  const bool head = std::string_view(tag) == "th";
  std::string out = fmt::format("<tr><th scope=\"{}\">{}</th>", head ? "col" : "row", cells.front());
  for (std::size_t i = 1; i < cells.size(); ++i)
    out += head ? fmt::format("<th scope=\"col\">{}</th>", cells[i])
                : fmt::format("<{0}>{1}</{0}>", tag, cells[i]);
  return out + "</tr>\n";
}

}  // namespace faba
