#include "field/coil.h"

namespace faba {
namespace {

/// Two equal coaxial loops in series. One radius apart and with the same direction of current their field is
/// uniform to fourth order at the centre; sqrt(3) radii apart and opposed (Maxwell pair) its gradient is.
class Helmholtz {
 public:
  struct Params {
    double radius = 0.05;
    std::optional<double> distance;
    double turns = 100;
    bool opposed = false;
    double wire_radius = 1e-3;
  };
  static Schema<Params> schema() {
    return Schema<Params>("helmholtz", "Two equal coaxial loops in series: a uniform field or a gradient")
        .add("radius", &Params::radius, {.unit = "m", .min = 1e-6, .max = 10, .doc = "Radius of both loops"})
        .add("distance", &Params::distance,
             {.unit = "m",
              .min = 1e-6,
              .max = 10,
              .doc = "Distance between the loops; default: radius, or sqrt(3) radius if opposed"})
        .add("turns", &Params::turns, {.min = 1e-3, .max = 1e6, .doc = "Turns of each loop"})
        .add(
            "opposed", &Params::opposed,
            {.doc = "Opposed currents (Maxwell pair), the loop on the side of the axis reversed: a gradient, "
                    "zero field at the centre, dB/dz < 0 along the axis for a positive current"})
        .add("wire_radius", &Params::wire_radius,
             {.unit = "m",
              .min = 1e-9,
              .max = 1,
              .doc = "Radius of the wire; inside it the field is that at its surface"})
        .check([](const Params& p) -> std::string {
          return p.wire_radius < p.radius ? "" : "wire_radius must be smaller than radius";
        })
        .validity("Not valid closer to a wire than the thickness of the winding.");
  }
  explicit Helmholtz(const Params& p)
      : p_(p), half_(0.5 * p.distance.value_or(p.opposed ? std::sqrt(3.0) * p.radius : p.radius)) {}

  void add(const axial::Places& at, const axial::Components& b) const {
    std::vector<double> z(at.z.size());
    for (const double side : {-1.0, 1.0}) {
      for (std::size_t i = 0; i < z.size(); ++i) z[i] = at.z[i] - side * half_;
      const double sense = p_.opposed && side > 0 ? -1 : 1;
      axial::add_loop(p_.radius, p_.wire_radius, sense * p_.turns, {at.rho, z}, b);
    }
  }
  double clearance(double rho, double z) const {
    return std::max(0.0, norm(Vec2{rho - p_.radius, std::fabs(z) - half_}) - p_.wire_radius);
  }
  std::vector<Field::Stroke> outline(const Axis& axis) const {
    return {axis.circle(p_.radius, -half_), axis.circle(p_.radius, half_)};
  }

 private:
  Params p_;
  double half_;  ///< half the distance between the loops, m
};

}  // namespace

void add_helmholtz(FieldRegistry& r) { r.add<Coil<Helmholtz>>(); }

}  // namespace faba
