#pragma once
#include <algorithm>
#include <cmath>
#include <memory>

#include "core/schema.h"
#include "field/field.h"
#include "field/kernels/axial.h"

namespace faba {

/// Circuit and calibration of a coil: parameters common to all coils.
struct CircuitParams {
  std::string name;
  double gain = 1;
  double current = 0;
  std::optional<double> max_current;
  std::optional<double> resistance, inductance;
  static Schema<CircuitParams> schema();
  Circuit circuit() const;
};

/// Position and orientation of a coil with an axis.
struct PoseParams {
  Vec3 position;
  Vec3 axis{0, 0, 1};
  static Schema<PoseParams> schema();
};

/// Transformation between the world frame and cylindrical coordinates about an axis.
class Axis {
 public:
  /// Origin in m, world frame; `direction` is not zero and of any length.
  Axis(Vec3 origin, Vec3 direction);
  /// Cylindrical coordinates rho and z of every point, m.
  void cylindrical(std::span<const Vec3> at, std::span<double> rho, std::span<double> z) const;
  /// The vector with the components b_rho and b_z at `at`.
  Vec3 vector(Vec3 at, double b_rho, double b_z) const;
  /// A closed circle about the axis.
  Field::Stroke circle(double radius, double z) const;
  /// A line at distance `rho` from the axis and azimuth `turn` (rad), from z0 to z1.
  Field::Stroke line(double rho, double turn, double z0, double z1) const;

 private:
  Vec3 origin_, direction_, across_, third_;
};

/// A coil that is symmetric about its axis. `Source` is its shape:
///   Source::Params and Source::schema(), with the parameters of the shape only;
///   Source(Params);
///   add(Places, Components): adds the field of 1 A through the coil;
///   clearance(rho, z): distance to the nearest winding, m;
///   encloses(rho, z), optional: whether a point is in its bore, winding or core;
///   outline(Axis): strokes.
template <class Source>
class Coil final : public Field {
 public:
  struct Params {
    typename Source::Params shape;
    PoseParams pose;
    CircuitParams circuit;
  };
  static constexpr std::array kTraits = {Trait::coil};
  static Schema<Params> schema() {
    const auto shape = Source::schema();
    return Schema<Params>(shape.name(), shape.summary())
        .include(&Params::shape, shape)
        .include(&Params::pose, PoseParams::schema())
        .include(&Params::circuit, CircuitParams::schema())
        .validity(shape.validity());
  }
  Coil(const Params& p, const FieldContext&)
      : circuit_(p.circuit), source_(p.shape), axis_(p.pose.position, p.pose.axis) {}

  std::size_t coils() const override { return 1; }
  void per_ampere(std::size_t, std::span<const Vec3> at, std::span<Vec3> b) const override {
    std::vector<double> rho(at.size()), z(at.size()), b_rho(at.size()), b_z(at.size());
    axis_.cylindrical(at, rho, z);
    source_.add({rho, z}, {b_rho, b_z});
    for (std::size_t i = 0; i < at.size(); ++i) b[i] = circuit_.gain * axis_.vector(at[i], b_rho[i], b_z[i]);
  }
  Circuit circuit(std::size_t) const override { return circuit_.circuit(); }
  double clearance(Vec3 at) const override {
    double rho = 0, z = 0;
    axis_.cylindrical({&at, 1}, {&rho, 1}, {&z, 1});
    return source_.clearance(rho, z);
  }
  bool encloses(std::size_t, Vec3 at) const override {
    if constexpr (requires { source_.encloses(0.0, 0.0); }) {
      double rho = 0, z = 0;
      axis_.cylindrical({&at, 1}, {&rho, 1}, {&z, 1});
      return source_.encloses(rho, z);
    }
    return false;
  }
  std::vector<Stroke> outline() const override { return source_.outline(axis_); }

 private:
  CircuitParams circuit_;
  Source source_;
  Axis axis_;
};

}  // namespace faba
