#include "field/coil.h"

namespace faba {
namespace {

/// A winding of one layer as a cylindrical current sheet, without approximation (theory C1), optionally with
/// a ferrite rod (C5): a second sheet around the rod with the equivalent current of its magnetisation,
///   K_core = (permeability - 1) B_winding(centre) / mu0.
/// Not valid within five pitches of the winding, where the field of the single wires matters (C2). The
/// rod is a surrogate with two parameters to be fitted: it is uniformly magnetised, without saturation,
/// remanence or interaction with the rods of other coils.
class Solenoid {
 public:
  struct Params {
    double radius = 0.005;
    double length = 0.04;
    double turns = 400;
    std::optional<double> wire_radius;
    double core_permeability = 1;
    std::optional<double> core_length, core_radius;
  };
  static Schema<Params> schema();
  explicit Solenoid(const Params& p);

  void add(const axial::Places& at, const axial::Components& b) const {
    axial::add_sheet(p_.radius, p_.length / 2, wire_, p_.turns / p_.length, at, b);
    if (core_sheet_ != 0) axial::add_sheet(core_radius_, core_half_, wire_, core_sheet_, at, b);
  }
  double clearance(double rho, double z) const {
    const auto to_sheet = [&](double a, double half) {
      return std::max(0.0, norm(Vec2{rho - a, std::max(0.0, std::fabs(z) - half)}) - wire_);
    };
    const double winding = to_sheet(p_.radius, p_.length / 2);
    return core_sheet_ == 0 ? winding : std::min(winding, to_sheet(core_radius_, core_half_));
  }
  bool encloses(double rho, double z) const {
    const bool in_core = core_sheet_ != 0 && rho <= core_radius_ && std::fabs(z) <= core_half_;
    return in_core || (rho <= p_.radius && std::fabs(z) <= p_.length / 2);
  }
  std::vector<Field::Stroke> outline(const Axis& axis) const {
    std::vector<Field::Stroke> s;
    const double half = p_.length / 2;
    for (const double z : {-half, half}) s.push_back(axis.circle(p_.radius, z));
    for (int side = 0; side < 4; ++side)
      s.push_back(axis.line(p_.radius, side * 1.5707963267948966, -half, half));
    return s;
  }

 private:
  Params p_;
  double wire_, core_radius_, core_half_;
  double core_sheet_ = 0;  ///< surface current of the rod per ampere in the winding, 1/m
};

Schema<Solenoid::Params> Solenoid::schema() {
  return Schema<Params>("solenoid", "A winding of one layer, optionally with a ferrite rod")
      .add("radius", &Params::radius, {.unit = "m", .min = 1e-6, .max = 10, .doc = "Radius of the winding"})
      .add("length", &Params::length, {.unit = "m", .min = 1e-6, .max = 10, .doc = "Length of the winding"})
      .add("turns", &Params::turns, {.min = 1e-3, .max = 1e7, .doc = "Number of turns"})
      .add("wire_radius", &Params::wire_radius,
           {.unit = "m",
            .min = 1e-9,
            .max = 1,
            .doc = "Radius of the wire: the smallest distance from the rims, where the field of a current "
                   "sheet diverges; default: half a pitch, at most 10 % of radius"})
      .add("core_permeability", &Params::core_permeability,
           {.min = 1,
            .max = 1e4,
            .doc = "Apparent permeability of a ferrite rod; 1: no rod. That of a short rod depends on its "
                   "aspect ratio, not on the material",
            .source = "rods with aspect ratio 2, 4, 8, 16: 5.8, 13, 35, 103 at most (C5)"})
      .add("core_length", &Params::core_length,
           {.unit = "m", .min = 1e-6, .max = 10, .doc = "Length of the rod; default: that of the winding"})
      .add("core_radius", &Params::core_radius,
           {.unit = "m", .min = 1e-6, .max = 10, .doc = "Radius of the rod; default: that of the winding"})
      .check([](const Params& p) -> std::string {
        if (p.core_radius && *p.core_radius > p.radius) return "core_radius must not be above radius";
        if (p.wire_radius && *p.wire_radius >= p.radius) return "wire_radius must be smaller than radius";
        return {};
      })
      .validity(
          "Not valid within five pitches of the winding, where the field of the single wires matters. The "
          "rod is a surrogate to be fitted: it has no saturation (0.3-0.5 T), no remanence and no "
          "interaction with the rods of other coils.");
}

Solenoid::Solenoid(const Params& p)
    : p_(p),
      wire_(p.wire_radius.value_or(std::min(0.5 * p.length / p.turns, 0.1 * p.radius))),
      core_radius_(p.core_radius.value_or(p.radius)),
      core_half_(p.core_length.value_or(p.length) / 2) {
  if (p.core_permeability == 1) return;
  const double centre = 0;
  double b_rho = 0, b_z = 0;
  axial::add_sheet(p.radius, p.length / 2, wire_, p.turns / p.length, {{&centre, 1}, {&centre, 1}},
                   {{&b_rho, 1}, {&b_z, 1}});
  core_sheet_ = (p.core_permeability - 1) * b_z / axial::kMu0;
}

}  // namespace

void add_solenoid(FieldRegistry& r) { r.add<Coil<Solenoid>>(); }

}  // namespace faba
