#pragma once
#include <array>
#include <cstddef>
#include <limits>
#include <span>
#include <string>
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

/// What is known of a coil beside its field.
struct Circuit {
  std::string name = {};                                         ///< for messages and legends
  double current = 0;                                            ///< A, what flows when nobody says otherwise
  double max_current = std::numeric_limits<double>::infinity();  ///< A
  double resistance = 0;                                         ///< ohm
  double lag = 0;  ///< time constant L/R with which the current follows its command, s; 0 is at once
};

/// Magnetic field of a set of coils, linear in their currents: B(r) = B_0 + sum_k I_k b_k(r), with B_0 the
/// Earth's field. World frame: x to the right, y up, z towards the camera; the swarm swims at z = 0.
class Field {
 public:
  /// An open or closed line that shows where a coil is, world frame, m.
  using Stroke = std::vector<Vec3>;

  virtual ~Field() = default;
  /// Number of coils, that is of currents.
  virtual std::size_t coils() const = 0;
  /// b_k in T/A at every point (m); spans have equal length.
  virtual void per_ampere(std::size_t coil, std::span<const Vec3> at, std::span<Vec3> b) const = 0;
  virtual Circuit circuit(std::size_t coil) const = 0;
  /// The part that no current makes: the Earth's field, T.
  virtual Vec3 ambient() const { return {}; }
  /// Distance from a point to the nearest winding or magnet, m, never negative. Closer than a few pitches of
  /// a winding the field of its model is not that of the wires.
  virtual double clearance(Vec3) const { return std::numeric_limits<double>::infinity(); }
  virtual std::vector<Stroke> outline() const { return {}; }
  /// The in-plane part of B in T at many points, for `current` in A, one per coil. For fields that are the
  /// same everywhere this costs nothing; others are tabulated (FieldTable) before a swarm swims in them.
  virtual void eval(const Points& at, std::span<const double> current, Vectors b) const;
  /// Whether B depends on the place.
  virtual bool varies() const { return true; }

  /// Field per ampere of each coil (T/A) at a point and its gradient (T/(A m)), both of size coils();
  /// `gradient` may be empty. Gradients are central differences of sixth order over a hundredth of the
  /// clearance: good to 1e-10 of b / clearance.
  void basis(Vec3 at, std::span<Vec3> b, std::span<Mat3> gradient) const;
  /// B at one point, T.
  Vec3 at(Vec3 point, std::span<const double> current) const;
  /// B at many points, T; spans have equal length.
  void at(std::span<const Vec3> points, std::span<const double> current, std::span<Vec3> b) const;
  /// What flows in every coil when nobody says otherwise, A.
  std::vector<double> default_currents() const;
  /// The largest current of every coil where `limit` is the largest of all, A.
  std::vector<double> max_currents(double limit) const;
};

/// Nothing yet: a field is built from its own parameters alone.
struct FieldContext {};
using FieldRegistry = Registry<Field, FieldContext>;

}  // namespace faba
