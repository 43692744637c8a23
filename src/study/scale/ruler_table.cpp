#include "study/scale/ruler_table.h"

#include <algorithm>
#include <cctype>
#include <cmath>
#include <optional>
#include <stdexcept>
#include <string>

#include <fmt/format.h>

#include "core/error.h"
#include "core/table.h"
#include "core/units.h"

namespace faba {
namespace {

std::string lower(std::string text) {
  std::transform(text.begin(), text.end(), text.begin(),
                 [](unsigned char c) { return char(std::tolower(c)); });
  return text;
}

/// The words of a column's name, separated by spaces, underscores, brackets and punctuation.
std::vector<std::string> words_of(const std::string& name) {
  std::vector<std::string> words(1);
  for (char c : name) {
    if (std::string_view(" _-()[]/,;:").find(c) == std::string_view::npos)
      words.back() += c;
    else if (!words.back().empty())
      words.emplace_back();
  }
  if (words.back().empty()) words.pop_back();
  return words;
}

bool names_pixels(const std::string& name) {
  const std::string n = lower(name);
  return n.find("px") != std::string::npos || n.find("pixel") != std::string::npos;
}

/// The unit of length at the end of a name, in m.
std::optional<double> length_unit(const std::string& name) {
  const auto words = words_of(name);
  if (words.empty() || names_pixels(name)) return std::nullopt;
  std::string unit = words.back();
  if (lower(unit) == "micron" || lower(unit) == "microns") unit = "um";
  try {
    const Quantity q = parse_unit(unit);
    if (q.dimension == parse_unit("m").dimension) return q.value;
  } catch (const std::invalid_argument&) {
  }
  return std::nullopt;
}

/// Name and unit of the column with widths.
std::pair<std::string, double> width_column(const Table& table) {
  std::vector<std::pair<std::string, double>> found;
  for (const std::string& name : table.names())
    if (const auto unit = length_unit(name)) found.emplace_back(name, *unit);
  if (found.size() == 1) return found.front();
  if (found.empty())
    throw Error(Errc::input, table.source(),
                "has no column of widths with a unit, such as width_um or width_mm; add one beside the "
                "readings in px");
  throw Error(
      Errc::input, table.source(),
      fmt::format("has two columns with a unit of length, {} and {}; only the column of widths may have one: "
                  "rename the other to px_1 if it has the readings in pixels, or remove it",
                  found[0].first, found[1].first));
}

double positive(const Table& table, const std::string& column, std::size_t row) {
  const double v = table.column(column)[row];
  if (v > 0) return v;
  throw Error(Errc::input, table.location(row),
              std::isnan(v)
                  ? fmt::format("{} is empty or not a number; for different numbers of readings write "
                                "one row per reading: width_um,px",
                                column)
                  : fmt::format("{} is {}; it must be greater than 0", column, v));
}

}  // namespace

bool is_ruler_table(const std::filesystem::path& file) {
  const std::string end = lower(file.extension().string());
  return end == ".csv" || end == ".tsv" || end == ".txt" || end == ".dat";
}

RulerReadings read_ruler_table(const std::filesystem::path& file) {
  const Table table = read_table(file);
  const auto [width, unit] = width_column(table);
  std::vector<std::string> columns;
  const auto& names = table.names();
  const bool named = std::any_of(names.begin(), names.end(), names_pixels);
  for (const std::string& name : names)
    if (name != width && (!named || names_pixels(name))) columns.push_back(name);
  if (columns.empty())
    throw Error(Errc::input, table.source(), "has no column of readings in pixels beside " + width);
  if (table.size() == 0) throw Error(Errc::input, table.source(), "has a header but no readings");
  RulerReadings out;
  for (std::size_t row = 0; row < table.size(); ++row)
    for (const std::string& name : columns) {
      out.width_m.push_back(positive(table, width, row) * unit);
      out.reading_px.push_back(positive(table, name, row));
    }
  return out;
}

}  // namespace faba
