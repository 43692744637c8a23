#include "field/coil.h"

namespace faba {
namespace {

/// A winding of many layers: uniform current density between two cylinders. Current sheets at the radii of a
/// Gauss-Legendre rule (theory C2); the error is below 1e-12 beyond half the thickness of the winding.
/// Not valid inside the winding, where the field of the single sheets matters.
class ThickCoil {
 public:
  struct Params {
    double inner_radius = 0.005;
    double outer_radius = 0.01;
    double length = 0.02;
    double turns = 400;
  };
  static Schema<Params> schema() {
    return Schema<Params>("thick_coil", "A winding of many layers")
        .add("inner_radius", &Params::inner_radius,
             {.unit = "m", .min = 1e-6, .max = 10, .doc = "Inner radius"})
        .add("outer_radius", &Params::outer_radius,
             {.unit = "m", .min = 1e-6, .max = 10, .doc = "Outer radius"})
        .add("length", &Params::length, {.unit = "m", .min = 1e-6, .max = 10, .doc = "Length of the winding"})
        .add("turns", &Params::turns, {.min = 1e-3, .max = 1e7, .doc = "Number of turns"})
        .check([](const Params& p) -> std::string {
          return p.outer_radius > p.inner_radius ? "" : "outer_radius must be larger than inner_radius";
        })
        .validity("Not valid inside the winding, or closer to it than a quarter of its thickness.");
  }
  explicit ThickCoil(const Params& p) : p_(p) {}

  void add(const axial::Places& at, const axial::Components& b) const {
    const double middle = 0.5 * (p_.inner_radius + p_.outer_radius),
                 half = 0.5 * (p_.outer_radius - p_.inner_radius);
    for (std::size_t i = 0; i < kNodes.size(); ++i)
      for (const double side : {-1.0, 1.0})
        axial::add_sheet(middle + side * half * kNodes[i], p_.length / 2, 0.01 * half,
                         0.5 * kWeights[i] * p_.turns / p_.length, at, b);
  }
  double clearance(double rho, double z) const {
    const double out = std::max({p_.inner_radius - rho, rho - p_.outer_radius, 0.0});
    return norm(Vec2{out, std::max(0.0, std::fabs(z) - p_.length / 2)});
  }
  bool encloses(double rho, double z) const {
    return rho <= p_.outer_radius && std::fabs(z) <= p_.length / 2;
  }
  std::vector<Field::Stroke> outline(const Axis& axis) const {
    std::vector<Field::Stroke> s;
    for (const double z : {-p_.length / 2, p_.length / 2})
      for (const double a : {p_.inner_radius, p_.outer_radius}) s.push_back(axis.circle(a, z));
    for (int side = 0; side < 4; ++side)
      s.push_back(axis.line(p_.outer_radius, side * 1.5707963267948966, -p_.length / 2, p_.length / 2));
    return s;
  }

 private:
  // Positive nodes of the Gauss-Legendre rule of 16 points and their weights (Abramowitz and Stegun,
  // table 25.4).
  static constexpr std::array<double, 8> kNodes{
      0.095012509837637440, 0.281603550779258913, 0.458016777657227386, 0.617876244402643748,
      0.755404408355003034, 0.865631202387831744, 0.944575023073232576, 0.989400934991649933};
  static constexpr std::array<double, 8> kWeights{
      0.189450610455068496, 0.182603415044923589, 0.169156519395002538, 0.149595988816576732,
      0.124628971255533872, 0.095158511682492785, 0.062253523938647893, 0.027152459411754095};
  Params p_;
};

}  // namespace

void add_thick_coil(FieldRegistry& r) { r.add<Coil<ThickCoil>>(); }

}  // namespace faba
