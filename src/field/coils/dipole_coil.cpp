#include "field/coil.h"

#include "core/portable_math.h"

namespace faba {
namespace {

/// A point dipole of moment `moment` per ampere: the far field of any coil (theory C2) and, with a constant
/// current, the field of a small magnet.
///   B_rho = 3 mu0 m rho z / (4 pi r^5),  B_z = mu0 m (2 z^2 - rho^2) / (4 pi r^5)
class DipoleCoil {
 public:
  struct Params {
    double moment = 0.03;
    double radius = 1e-3;
  };
  static Schema<Params> schema() {
    return Schema<Params>("dipole", "A point dipole: the far field of a coil or a small magnet")
        .add("moment", &Params::moment,
             {.unit = "A m^2/A", .min = -1e6, .max = 1e6, .doc = "Moment per ampere: turns x area"})
        .add("radius", &Params::radius,
             {.unit = "m",
              .min = 1e-9,
              .max = 10,
              .doc = "Radius of the body; inside it the field is that at its surface"})
        .validity("Not valid within about five times the size of the coil.");
  }
  explicit DipoleCoil(const Params& p) : p_(p) {}

  void add(const axial::Places& at, const axial::Components& b) const {
    for (std::size_t i = 0; i < at.rho.size(); ++i) {
      double rho = at.rho[i], z = at.z[i], r = norm(Vec2{rho, z});
      if (r < p_.radius) {
        const double out = r > 0 ? p_.radius / r : 0;
        rho *= out;
        z = r > 0 ? z * out : p_.radius;
        r = p_.radius;
      }
      const double f = axial::kMu0 * p_.moment / (4 * portable::kPi * r * r * r * r * r);
      b.rho[i] += 3 * f * rho * z;
      b.z[i] += f * (2 * z * z - rho * rho);
    }
  }
  double clearance(double rho, double z) const { return std::max(0.0, norm(Vec2{rho, z}) - p_.radius); }
  std::vector<Field::Stroke> outline(const Axis& axis) const {
    return {axis.circle(p_.radius, 0), axis.line(0, 0, -2 * p_.radius, 2 * p_.radius)};
  }

 private:
  Params p_;
};

}  // namespace

void add_dipole_coil(FieldRegistry& r) { r.add<Coil<DipoleCoil>>(); }

}  // namespace faba
