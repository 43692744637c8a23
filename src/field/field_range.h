#pragma once
#include <span>
#include <vector>

#include "field/field.h"

namespace faba {

/// The fields in the plane that a coil system can produce at a point: B_E + sum of I_k b_k with all |I_k| at
/// most their limit. They fill a polygon (theory C8).
class FieldRange {
 public:
  /// `most`: limits of the currents, A, one per coil.
  FieldRange(const Field& field, Vec3 at, std::span<const double> most);
  /// Whether the field is known at this point: it is not in a winding or outside a measured map.
  bool known() const { return known_; }
  /// Largest field exactly along a direction (rad, from x to y), T; 0 if no currents produce that direction.
  double along(double angle) const;
  /// The direction in which along() is smallest.
  struct Weakest {
    double angle = 0, tesla = 0;
  };
  Weakest weakest() const;

 private:
  /// Distance from B = 0 to the side of the polygon with the outward normal n, T; negative outside.
  double distance(Vec2 n) const;

  std::vector<Vec2> coil_;     ///< field of every coil at its largest current, T; those with a field only
  std::vector<Vec2> normals_;  ///< of the sides of the polygon
  Vec2 ambient_;
  double rounding_ = 0;  ///< error of the sums below, T
  bool known_ = true;
};

}  // namespace faba
