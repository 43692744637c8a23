#include "field/field_data.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>
#include <optional>
#include <span>

#include "core/error.h"
#include "field/field_columns.h"

namespace faba {
namespace {

constexpr double kLargestValue = 1e3;  // m and T

/// One quantity among the columns, in SI units.
struct Column {
  std::span<const double> values;
  double in_si;
  double operator[](std::size_t row) const { return values[row] * in_si; }
};

// The column of `quantity`.
std::optional<Column> column_of(const Table& t, const std::string& quantity) {
  for (const std::string& name : t.names()) {
    const auto column = field_column(name);
    if (!column || column->quantity != quantity) continue;
    if (column->unit) return Column{t.column(name), column->unit->in_si};
    throw Error(Errc::input, t.source(),
                fmt::format("column \"{}\" has no known unit; write it like \"{} ({})\" or give {}", name,
                            quantity, column->is_field() ? "mT" : "mm",
                            column->is_field() ? "T, mT, uT, nT or gauss" : "m, cm, mm, um or inch"));
  }
  return std::nullopt;
}

// The component of a column "B": along the only coordinate.
std::size_t scanned_axis(const std::string& source, const std::array<std::optional<Column>, 3>& place,
                         bool about_axis) {
  const auto given = std::count_if(place.begin(), place.end(), [](const auto& c) { return c.has_value(); });
  if (given != 1 || (about_axis && place[0]))
    throw Error(Errc::input, source,
                "column \"B\" does not state which component it is: this is clear only along one axis; name "
                "it bx, by or bz");
  return std::size_t(std::find_if(place.begin(), place.end(), [](const auto& c) { return c.has_value(); }) -
                     place.begin());
}

FieldData from_columns(const Table& t) {
  FieldData d;
  d.source = t.source();
  const auto rho = column_of(t, "rho"), b_rho = column_of(t, "brho");
  d.about_axis = rho || b_rho;
  const std::array<std::optional<Column>, 3> place{d.about_axis ? rho : column_of(t, "x"), column_of(t, "y"),
                                                   column_of(t, "z")};
  std::array<std::optional<Column>, 3> field{d.about_axis ? b_rho : column_of(t, "bx"), column_of(t, "by"),
                                             column_of(t, "bz")};
  const auto any = [](const auto& list) {
    return std::any_of(list.begin(), list.end(), [](const auto& c) { return c.has_value(); });
  };
  if (!any(field) && any(place))
    if (const auto along = column_of(t, "b")) field[scanned_axis(d.source, place, d.about_axis)] = along;
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
