#pragma once
#include "field/field.h"

namespace faba {

/// Nodes of a square grid in the plane z = 0, row by row from the lower left.
struct TableGrid {
  Vec2 low;            ///< the first node, m, world
  double spacing = 0;  ///< m
  int columns = 0, rows = 0;
  std::size_t nodes() const { return std::size_t(columns) * std::size_t(rows); }
  Vec2 high() const { return low + spacing * Vec2{double(columns - 1), double(rows - 1)}; }
};

/// A field in the plane z = 0 over a rectangle, tabulated for evaluation at many points: the field per ampere
/// of every coil at the nodes of a square grid, summed once per set of currents and interpolated bilinearly.
class FieldTable {
 public:
  /// Largest error of the table, as a fraction of the largest field of each coil in the rectangle.
  static constexpr double kTolerance = 1e-5;

  /// World frame, m. The spacing follows from the tolerance. Throws Error(usage, "field") when a coil is
  /// inside the rectangle, or so close that a table of a million nodes does not reach the tolerance.
  FieldTable(const Field& field, Vec2 low, Vec2 high);
  /// With the given grid; error() may exceed the tolerance. Throws Error(usage, "field") when a coil is
  /// inside.
  FieldTable(const Field& field, const TableGrid& grid);

  /// Sets the currents (A, one per coil) for eval(). Recomputes all nodes when they changed.
  void set(std::span<const double> current);
  /// The in-plane field, T. Points outside the rectangle are clamped to its border.
  void eval(const Points& at, Vectors b) const;

  const TableGrid& grid() const { return grid_; }
  /// The in-plane field at every node, T: x, y, x, y ...
  std::span<const float> nodes() const { return nodes_; }
  /// Largest error of the table, as a fraction as in kTolerance: measured at the centres of the squares,
  /// where bilinear interpolation is worst.
  double error() const { return error_; }
  /// Largest in-plane field at any node for currents up to the given ones (A, one per coil), T.
  double strongest(std::span<const double> max_current) const;

 private:
  void fill(const Field& field);
  double measure(const Field& field) const;

  TableGrid grid_;
  Vec3 ambient_;
  double error_ = 0;
  std::vector<std::vector<Vec2>> basis_;  ///< of every coil, T/A, row by row
  std::vector<float> nodes_;              ///< T, x and y of every node
  std::vector<double> current_;
};

}  // namespace faba
