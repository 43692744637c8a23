#pragma once
#include <cstddef>
#include <span>
#include <vector>

#include "core/registry.h"

namespace faba {

/// Many points of one horizontal plane. World frame, m.
struct Points {
  std::span<const float> x, y;
  float z = 0;
};
/// The field's components at the points, T.
struct Vectors {
  std::span<float> x, y;
};

/// Magnetic field of a set of coils, linear in their currents: B(r) = B0 + sum_k I_k b_k(r), with B0 the
/// Earth's field.
class Field {
 public:
  virtual ~Field() = default;
  /// Number of coils, that is of currents.
  virtual std::size_t coils() const = 0;
  /// B in T at every point, for `current` in A, one per coil. Spans have equal length. Called once per block
  /// of agents.
  virtual void eval(const Points& at, std::span<const double> current, Vectors b) const = 0;
  /// Field per ampere of each coil (T/A) and its gradient (T/(A m)), both of size coils(); `gradient` may be
  /// empty.
  virtual void basis(Vec3 at, std::span<Vec3> b, std::span<Mat3> gradient) const = 0;
  /// The part that no current makes: the Earth's field, T.
  virtual Vec3 ambient() const = 0;
  /// Time constant L/R with which each coil's current follows its command, s; 0 is at once.
  virtual std::vector<double> lag() const = 0;

  /// B at one point, T.
  Vec3 at(Vec3 point, std::span<const double> current) const;
};

/// Nothing yet: a field is built from its own parameters alone.
struct FieldContext {};
using FieldRegistry = Registry<Field, FieldContext>;

}  // namespace faba
