#include "app/files/field_points.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cctype>
#include <cmath>

#include "core/error.h"
#include "core/h5/h5.h"

namespace faba {
namespace {

constexpr double kLargest = 1e3;  // m and T

std::vector<double> numbers(const H5Table& t) {
  std::vector<double> v(std::size_t(t.rows()));
  if (t.row_size() == 1)
    for (std::size_t i = 0; i < v.size(); ++i) t.read<double>(i, {&v[i], 1});
  return v;
}

Table from_hdf5(const std::filesystem::path& file) {
  const H5File h5 = H5File::open(file);
  const H5Table b = h5.table("b_t");
  const std::vector<double> x = numbers(h5.table("x_m")), y = numbers(h5.table("y_m"));
  const std::vector<double> z = h5.has("z_m") ? numbers(h5.table("z_m")) : std::vector<double>();
  const std::size_t rows = b.rows(), columns = b.row_size() / 3;
  const bool grid = b.row_size() != 3;
  if (b.row_size() % 3 != 0 || y.size() != rows || x.size() != (grid ? columns : rows) ||
      (!z.empty() && (grid || z.size() != rows)))
    throw Error(Errc::input, file.string(),
                "the sizes of b_t, x_m, y_m and z_m do not match; see `faba parts field map`");
  std::vector<std::vector<double>> columns_of_points(6);
  std::vector<double> row(b.row_size());
  for (std::size_t r = 0; r < rows; ++r) {
    b.read<double>(r, row);
    for (std::size_t c = 0; c < columns; ++c) {
      const std::array<double, 6> values{grid ? x[c] : x[r], y[r],           z.empty() ? 0 : z[r],
                                         row[3 * c],         row[3 * c + 1], row[3 * c + 2]};
      for (std::size_t k = 0; k < values.size(); ++k) {
        if (!(std::fabs(values[k]) <= kLargest))
          throw Error(
              Errc::input, file.string(),
              fmt::format("a value in row {} is not finite or greater than {:g} m or T", r, kLargest));
        columns_of_points[k].push_back(values[k]);
      }
    }
  }
  return {file.string(), {"x_m", "y_m", "z_m", "bx_t", "by_t", "bz_t"}, std::move(columns_of_points)};
}

}  // namespace

Table read_field_points(const std::filesystem::path& file, const FieldTableFormat& format) {
  std::string extension = file.extension().string();
  for (char& c : extension) c = char(std::tolower(static_cast<unsigned char>(c)));
  if (extension != ".h5" && extension != ".hdf5") return read_field_table(file, format);
  if (!format.empty())
    throw Error(Errc::usage, format.columns.empty() ? "--units" : "--columns",
                "is for text files; the datasets of an HDF5 file have names and SI units");
  return from_hdf5(file);
}

}  // namespace faba
