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

/// Electrical properties of a coil.
struct Circuit {
  std::string name = {};                                         ///< for messages and legends
  double current = 0;                                            ///< default current, A
  double max_current = std::numeric_limits<double>::infinity();  ///< A
  double resistance = 0;                                         ///< ohm
  double lag = 0;  ///< time constant L/R of the current, s; 0: the current follows its command at once
};

/// Magnetic field of a set of coils, linear in their currents: B(r) = B_0 + sum_k I_k b_k(r), with B_0 the
/// Earth's field. World frame: x to the right, y up, z towards the camera; the swarm swims at z = 0.
class Field {
 public:
  /// An open or closed line that shows where a coil is, world frame, m.
  using Stroke = std::vector<Vec3>;

  virtual ~Field() = default;
  /// Number of coils and of currents.
  virtual std::size_t coils() const = 0;
  /// b_k in T/A at every point (m); spans have equal length.
  virtual void per_ampere(std::size_t coil, std::span<const Vec3> at, std::span<Vec3> b) const = 0;
  virtual Circuit circuit(std::size_t coil) const = 0;
  /// The field without currents: the Earth's field, T.
  virtual Vec3 ambient() const { return {}; }
  /// Distance from a point to the nearest winding or magnet, m, not negative. Within a few winding pitches
  /// the field of the model differs from that of the single wires.
  virtual double clearance(Vec3) const { return std::numeric_limits<double>::infinity(); }
  /// Whether a point is in the bore, winding or core of a coil.
  virtual bool encloses(std::size_t /*coil*/, Vec3 /*at*/) const { return false; }
  virtual std::vector<Stroke> outline() const { return {}; }
  /// The in-plane part of B in T at many points, for `current` in A, one per coil. Cheap for uniform fields;
  /// other fields are tabulated (FieldTable) for simulation.
  virtual void eval(const Points& at, std::span<const double> current, Vectors b) const;
  /// Whether B depends on the position.
  virtual bool varies() const { return true; }

  /// Field per ampere of each coil (T/A) at a point and its gradient (T/(A m)), both of size coils();
  /// `gradient` may be empty. Gradients are central differences of sixth order with a step of 1 % of the
  /// clearance; their error is 1e-10 of b / clearance.
  void basis(Vec3 at, std::span<Vec3> b, std::span<Mat3> gradient) const;
  /// B at one point, T.
  Vec3 at(Vec3 point, std::span<const double> current) const;
  /// B at many points, T; spans have equal length.
  void at(std::span<const Vec3> points, std::span<const double> current, std::span<Vec3> b) const;
  /// Default current of every coil, A.
  std::vector<double> default_currents() const;
  /// Largest current of every coil, A; none is larger than `limit`.
  std::vector<double> max_currents(double limit) const;
};

/// Empty: a field is built from its own parameters only.
struct FieldContext {};
using FieldRegistry = Registry<Field, FieldContext>;

}  // namespace faba
