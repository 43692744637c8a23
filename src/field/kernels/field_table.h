#pragma once
#include "field/field.h"

namespace faba {

/// Nodes of a square grid in the plane z = 0, from the lower left one on, row by row.
struct TableGrid {
  Vec2 low;            ///< the first node, m, world
  double spacing = 0;  ///< m
  int columns = 0, rows = 0;
  std::size_t nodes() const { return std::size_t(columns) * std::size_t(rows); }
  Vec2 high() const { return low + spacing * Vec2{double(columns - 1), double(rows - 1)}; }
};

/// A field in the plane z = 0 over a rectangle, made ready for many points: the field per ampere of every
/// coil at the nodes of a square grid, added up once per set of currents and interpolated bilinearly between
/// them.
class FieldTable {
 public:
  /// How far the table may be from the field, as a share of each coil's largest field in the rectangle.
  static constexpr double kTolerance = 1e-5;

  /// World frame, m. The spacing follows from the tolerance. Throws Error(usage, "field") when a coil reaches
  /// into the rectangle, or so near to it that no table of a million nodes is good enough.
  FieldTable(const Field& field, Vec2 low, Vec2 high);
  /// With nodes as given, whatever error() they lead to. Throws likewise for coils that reach in.
  FieldTable(const Field& field, const TableGrid& grid);

  /// Sets the currents (A, one per coil) for eval(). Costs a pass over the nodes when they changed.
  void set(std::span<const double> current);
  /// The in-plane field, T. Points beyond the rectangle count as on its border.
  void eval(const Points& at, Vectors b) const;

  const TableGrid& grid() const { return grid_; }
  /// The in-plane field at every node, T: x, y, x, y ...
  std::span<const float> nodes() const { return nodes_; }
  /// Largest distance found between table and field, a share as in kTolerance: looked for at the centres of
  /// the squares, where bilinear interpolation is worst.
  double error() const { return error_; }
  /// Strongest in-plane field at any node for currents up to the given ones (A, one per coil), T.
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
