#include "field/field_data.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cctype>
#include <cmath>
#include <optional>
#include <span>

#include "core/error.h"
#include "core/h5.h"
#include "core/table.h"

namespace faba {
namespace {

struct Unit {
  const char* name;
  double in_si;
};
constexpr Unit kLengths[] = {{"m", 1}, {"cm", 1e-2}, {"mm", 1e-3}, {"um", 1e-6}};
constexpr double kLargest = 1e3;  // m and T
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

// The column of `quantity`, whose name is followed by one of the units.
std::optional<Column> column_of(const Table& t, const std::string& quantity, std::span<const Unit> units) {
  for (const std::string& name : t.names()) {
    const std::string word = lower(name);
    if (!word.starts_with(quantity + "_") && word != quantity) continue;
    const std::string unit = word.substr(std::min(word.size(), quantity.size() + 1));
    for (const Unit& u : units)
      if (unit == u.name) return Column{t.column(name), u.in_si};
    std::vector<std::string> known;
    for (const Unit& u : units) known.push_back(quantity + "_" + u.name);
    throw Error(Errc::input, t.source(),
                fmt::format("column {} must say its unit: {}", name, fmt::join(known, ", ")));
  }
  return std::nullopt;
}

FieldData from_csv(const std::filesystem::path& file) {
  const Table t = read_table(file);
  FieldData d;
  d.source = file.string();
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
                "has rho, a distance from an axis, as well as y; give one or the other");
  if (!any(place) || !any(field))
    throw Error(
        Errc::input, d.source,
        fmt::format("needs columns for {}, such as {}; it has {}", any(place) ? "the field" : "the place",
                    any(place) ? "bx_mt, by_mt, bz_mt" : "x_mm, y_mm, z_mm", fmt::join(t.names(), ", ")));
  for (std::size_t i = 0; i < t.size(); ++i) {
    std::array<double, 3> p{}, b{};
    for (std::size_t k = 0; k < 3; ++k) {
      if (place[k]) p[k] = (*place[k])[i];
      if (field[k]) b[k] = (*field[k])[i];
      if (std::isnan(p[k]) || std::isnan(b[k])) throw Error(Errc::input, t.place(i), "a value is missing");
      if (std::fabs(p[k]) > kLargest || std::fabs(b[k]) > kLargest)
        throw Error(Errc::input, t.place(i), "a value is beyond any laboratory's");
    }
    d.at.push_back({p[0], p[1], p[2]});
    d.b.push_back({b[0], b[1], b[2]});
  }
  for (std::size_t k = 0; k < 3; ++k) d.given[k] = field[k].has_value();
  return d;
}

std::vector<double> numbers(const H5Table& t) {
  std::vector<double> v(std::size_t(t.rows()));
  if (t.row_size() == 1)
    for (std::size_t i = 0; i < v.size(); ++i) t.read<double>(i, {&v[i], 1});
  return v;
}

FieldData from_hdf5(const std::filesystem::path& file) {
  const H5File h5 = H5File::open(file);
  const H5Table b = h5.table("b_t");
  const std::vector<double> x = numbers(h5.table("x_m")), y = numbers(h5.table("y_m"));
  const std::vector<double> z = h5.has("z_m") ? numbers(h5.table("z_m")) : std::vector<double>();
  const std::size_t rows = b.rows(), columns = b.row_size() / 3;
  const bool grid = b.row_size() != 3;
  if (b.row_size() % 3 != 0 || y.size() != rows || x.size() != (grid ? columns : rows) ||
      (!z.empty() && (grid || z.size() != rows)))
    throw Error(Errc::input, file.string(),
                "b_t, x_m, y_m and z_m do not fit together; see `faba parts field map`");
  FieldData d;
  d.source = file.string();
  d.given = {true, true, true};
  std::vector<double> row(b.row_size());
  for (std::size_t r = 0; r < rows; ++r) {
    b.read<double>(r, row);
    for (std::size_t c = 0; c < columns; ++c) {
      d.at.push_back({grid ? x[c] : x[r], y[r], z.empty() ? 0 : z[r]});
      d.b.push_back({row[3 * c], row[3 * c + 1], row[3 * c + 2]});
      const Vec3 p = d.at.back(), v = d.b.back();
      if (!(norm(p) <= kLargest && norm(v) <= kLargest))
        throw Error(Errc::input, d.source,
                    fmt::format("a value in row {} is not finite, or beyond any laboratory's", r));
    }
  }
  return d;
}

}  // namespace

FieldData read_field_data(const std::filesystem::path& file) {
  const std::string ending = lower(file.extension().string());
  FieldData d = ending == ".h5" || ending == ".hdf5" ? from_hdf5(file) : from_csv(file);
  if (d.at.empty()) throw Error(Errc::input, file.string(), "has no points");
  return d;
}

}  // namespace faba
