#pragma once
#include "field/field.h"

namespace faba {

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

  /// Sets the currents (A, one per coil) for eval(). Costs a pass over the nodes when they changed.
  void set(std::span<const double> current);
  /// The in-plane field, T. Points beyond the rectangle count as on its border.
  void eval(const Points& at, Vectors b) const;

  int columns() const { return columns_; }
  int rows() const { return rows_; }
  double spacing() const { return spacing_; }  ///< m
  /// Largest distance found between table and field, a share as in kTolerance: looked for at the centres of
  /// the squares, where bilinear interpolation is worst.
  double error() const { return error_; }
  /// Strongest in-plane field at any node for currents up to the given ones (A, one per coil), T.
  double strongest(std::span<const double> max_current) const;

 private:
  struct Node {
    float x, y;
  };
  void fill(const Field& field, double spacing);
  double measure(const Field& field) const;

  Vec2 low_, size_;
  Vec3 ambient_;
  double spacing_ = 0, error_ = 0;
  int columns_ = 0, rows_ = 0;
  std::vector<std::vector<Vec2>> basis_;  ///< of every coil, T/A, row by row
  std::vector<Node> nodes_;               ///< T
  std::vector<double> current_;
};

}  // namespace faba
