#include "field/kernels/field_table.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "core/vectorised.h"

namespace faba {
namespace {

constexpr int kFirst = 33;  // initial number of nodes along the longer side
constexpr int kMostNodes = 1 << 20;

struct Grid {
  const float* nodes;  ///< x, y of every node, row by row
  float left, low, by_spacing, last_column, last_row;
  int columns;
};

FABA_VECTORISED void interpolate(const Grid& g, const float* x, const float* y, float* bx, float* by,
                                 std::size_t n) {
  const float* nodes = g.nodes;
  const float left = g.left, low = g.low, scale = g.by_spacing, last_column = g.last_column,
              last_row = g.last_row;
  const int columns = g.columns;
  FABA_ELEMENTWISE
  for (std::size_t i = 0; i < n; ++i) {
    float u = (x[i] - left) * scale, v = (y[i] - low) * scale;
    u = u > 0.0f ? u : 0.0f;
    v = v > 0.0f ? v : 0.0f;
    u = u < last_column ? u : last_column;
    v = v < last_row ? v : last_row;
    const int column = int(u), row = int(v);
    const float fu = u - float(column), fv = v - float(row);
    const int a = 2 * (row * columns + column), b = a + 2 * columns;
    const float x0 = nodes[a] + fu * (nodes[a + 2] - nodes[a]),
                x1 = nodes[b] + fu * (nodes[b + 2] - nodes[b]);
    const float y0 = nodes[a + 1] + fu * (nodes[a + 3] - nodes[a + 1]),
                y1 = nodes[b + 1] + fu * (nodes[b + 3] - nodes[b + 1]);
    bx[i] = x0 + fv * (x1 - x0);
    by[i] = y0 + fv * (y1 - y0);
  }
}

}  // namespace

FieldTable::FieldTable(const Field& field, Vec2 low, Vec2 high) : ambient_(field.ambient()) {
  const Vec2 size = high - low;
  grid_ = {low, std::max(size.x, size.y) / (kFirst - 1), 0, 0};
  // The error is proportional to the square of the spacing; two attempts are enough unless a winding is near.
  for (int attempt = 0;; ++attempt) {
    const double nodes = (size.x / grid_.spacing + 2) * (size.y / grid_.spacing + 2);
    if (attempt == 4 || nodes > kMostNodes)
      throw Error(Errc::usage, "field",
                  "a coil is too close to the sample to tabulate its field; move the coil away or reduce the "
                  "size of the arena");
    grid_.columns = std::max(2, int(std::ceil(size.x / grid_.spacing - 1e-9)) + 1);
    grid_.rows = std::max(2, int(std::ceil(size.y / grid_.spacing - 1e-9)) + 1);
    fill(field);
    if (error_ <= kTolerance) break;
    grid_.spacing *= 0.8 * std::sqrt(kTolerance / error_);
  }
}

FieldTable::FieldTable(const Field& field, const TableGrid& grid) : grid_(grid), ambient_(field.ambient()) {
  fill(field);
}

void FieldTable::fill(const Field& field) {
  std::vector<Vec3> at;
  for (int r = 0; r < grid_.rows; ++r)
    for (int c = 0; c < grid_.columns; ++c)
      at.push_back({grid_.low.x + c * grid_.spacing, grid_.low.y + r * grid_.spacing, 0});
  for (const Vec3 p : at)
    if (field.clearance(p) <= grid_.spacing)
      throw Error(
          Errc::usage, "field",
          fmt::format("a coil or the edge of a measured map is in the sample plane z = 0, at "
                      "({:.3g}, {:.3g}) mm from its centre; move the coil away, reduce the size of the "
                      "arena or use a larger map",
                      p.x * 1e3, p.y * 1e3));
  basis_.assign(field.coils(), std::vector<Vec2>(at.size()));
  std::vector<Vec3> b(at.size());
  for (std::size_t k = 0; k < basis_.size(); ++k) {
    field.per_ampere(k, at, b);
    std::transform(b.begin(), b.end(), basis_[k].begin(), [](const Vec3& v) { return Vec2{v.x, v.y}; });
  }
  error_ = measure(field);
  nodes_.resize(2 * at.size());
  current_.assign(basis_.size(), std::numeric_limits<double>::quiet_NaN());
  set(std::vector<double>(basis_.size(), 0.0));
}

double FieldTable::measure(const Field& field) const {
  std::vector<Vec3> at;
  std::vector<std::size_t> corner;
  const int step = std::max(1, std::max(grid_.columns, grid_.rows) / 64);
  for (int r = 0; r + 1 < grid_.rows; r += step)
    for (int c = 0; c + 1 < grid_.columns; c += step) {
      at.push_back({grid_.low.x + (c + 0.5) * grid_.spacing, grid_.low.y + (r + 0.5) * grid_.spacing, 0});
      corner.push_back(std::size_t(r) * std::size_t(grid_.columns) + std::size_t(c));
    }
  std::vector<Vec3> exact(at.size());
  double worst = 0;
  for (std::size_t k = 0; k < basis_.size(); ++k) {
    const auto& b = basis_[k];
    double largest = 0, off = 0;
    for (const Vec2 v : b) largest = std::max(largest, norm(v));
    field.per_ampere(k, at, exact);
    for (std::size_t i = 0; i < at.size(); ++i) {
      const std::size_t j = corner[i], up = j + std::size_t(grid_.columns);
      const Vec2 middle = 0.25 * (b[j] + b[j + 1] + b[up] + b[up + 1]);
      off = std::max(off, norm(middle - Vec2{exact[i].x, exact[i].y}));
    }
    if (largest > 0) worst = std::max(worst, off / largest);
  }
  return worst;
}

void FieldTable::set(std::span<const double> current) {
  if (std::equal(current.begin(), current.end(), current_.begin(), current_.end())) return;
  current_.assign(current.begin(), current.end());
  for (std::size_t i = 0; i < grid_.nodes(); ++i) {
    Vec2 sum{ambient_.x, ambient_.y};
    for (std::size_t k = 0; k < basis_.size(); ++k) sum = sum + current_[k] * basis_[k][i];
    nodes_[2 * i] = float(sum.x);
    nodes_[2 * i + 1] = float(sum.y);
  }
}

void FieldTable::eval(const Points& at, Vectors b) const {
  const Grid g{nodes_.data(),
               float(grid_.low.x),
               float(grid_.low.y),
               float(1 / grid_.spacing),
               std::nextafter(float(grid_.columns - 1), 0.0f),
               std::nextafter(float(grid_.rows - 1), 0.0f),
               grid_.columns};
  interpolate(g, at.x.data(), at.y.data(), b.x.data(), b.y.data(), at.x.size());
}

double FieldTable::strongest(std::span<const double> max_current) const {
  double most = 0;
  for (std::size_t i = 0; i < grid_.nodes(); ++i) {
    Vec2 sum{std::fabs(ambient_.x), std::fabs(ambient_.y)};
    for (std::size_t k = 0; k < basis_.size(); ++k)
      sum =
          sum + Vec2{max_current[k] * std::fabs(basis_[k][i].x), max_current[k] * std::fabs(basis_[k][i].y)};
    most = std::max(most, norm(sum));
  }
  return most;
}

}  // namespace faba
