#include "field/field_data.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cctype>
#include <cmath>
#include <optional>
#include <span>

#include "core/error.h"

namespace faba {
namespace {

struct Unit {
  const char* name;
  double in_si;
};
constexpr Unit kLengths[] = {{"m", 1}, {"cm", 1e-2}, {"mm", 1e-3}, {"um", 1e-6}};
constexpr double kLargestValue = 1e3;  // m and T
constexpr Unit kFields[] = {{"t", 1}, {"mt", 1e-3}, {"ut", 1e-6}, {"nt", 1e-9}, {"gauss", 1e-4}};

std::string lower(std::string s) {
  for (char& c : s) c = char(std::tolower(static_cast<unsigned char>(c)));
  return s;
}

/// One quantity among the columns, in SI units.
struct Column {
  std::span<const double> values;
  double in_si;
  double operator[](std::size_t row) const { return values[row] * in_si; }
};

// The column of `quantity`; its name ends in one of the units.
std::optional<Column> column_of(const Table& t, const std::string& quantity, std::span<const Unit> units) {
  for (const std::string& name : t.names()) {
    const std::string word = lower(name);
    if (!word.starts_with(quantity + "_") && word != quantity) continue;
    const std::string unit = word.substr(std::min(word.size(), quantity.size() + 1));
    for (const Unit& u : units)
      if (unit == u.name) return Column{t.column(name), u.in_si};
    std::vector<std::string> known;
    for (const Unit& u : units) known.push_back(quantity + "_" + u.name);
    throw Error(
        Errc::input, t.source(),
        fmt::format("column \"{}\" has no known unit; permitted names: {}", name, fmt::join(known, ", ")));
  }
  return std::nullopt;
}

FieldData from_columns(const Table& t) {
  FieldData d;
  d.source = t.source();
  const auto rho = column_of(t, "rho", kLengths), b_rho = column_of(t, "brho", kFields);
  d.about_axis = rho || b_rho;
  const std::array<std::optional<Column>, 3> place{d.about_axis ? rho : column_of(t, "x", kLengths),
                                                   column_of(t, "y", kLengths), column_of(t, "z", kLengths)};
  const std::array<std::optional<Column>, 3> field{d.about_axis ? b_rho : column_of(t, "bx", kFields),
                                                   column_of(t, "by", kFields), column_of(t, "bz", kFields)};
  const auto any = [](const auto& list) {
    return std::any_of(list.begin(), list.end(), [](const auto& c) { return c.has_value(); });
  };
  if (d.about_axis && (place[1] || field[1]))
    throw Error(Errc::input, d.source,
                "has both rho, a distance from an axis, and a y component; specify one or the other");
  if (!any(place) || !any(field))
    throw Error(
        Errc::input, d.source,
        fmt::format("has no column for the {}, such as {}; its columns are {}",
                    any(place) ? "field" : "position",
                    any(place) ? "bx_mt, by_mt, bz_mt" : "x_mm, y_mm, z_mm", fmt::join(t.names(), ", ")));
  for (std::size_t i = 0; i < t.size(); ++i) {
    std::array<double, 3> p{}, b{};
    for (std::size_t k = 0; k < 3; ++k) {
      if (place[k]) p[k] = (*place[k])[i];
      if (field[k]) b[k] = (*field[k])[i];
      if (std::isnan(p[k]) || std::isnan(b[k])) throw Error(Errc::input, t.location(i), "a value is missing");
      if (std::fabs(p[k]) > kLargestValue || std::fabs(b[k]) > kLargestValue)
        throw Error(Errc::input, t.location(i),
                    "a value is out of range; at most 1000 m and 1000 T are permitted");
    }
    d.at.push_back({p[0], p[1], p[2]});
    d.b.push_back({b[0], b[1], b[2]});
  }
  for (std::size_t k = 0; k < 3; ++k) d.given[k] = field[k].has_value();
  return d;
}

}  // namespace

FieldData field_data(const Table& t) {
  FieldData d = from_columns(t);
  if (d.at.empty()) throw Error(Errc::input, d.source, "has no points; write one line per measured point");
  return d;
}

}  // namespace faba
