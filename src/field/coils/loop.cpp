#include "field/coil.h"

namespace faba {
namespace {

/// A circular loop, or a flat winding represented by `turns` loops at one position (theory C2).
/// Not valid closer to the wire than the thickness of the winding.
class Loop {
 public:
  struct Params {
    double radius = 0.01;
    double turns = 1;
    double wire_radius = 1e-4;
  };
  static Schema<Params> schema() {
    return Schema<Params>("loop", "A circular loop of one or more turns")
        .add("radius", &Params::radius, {.unit = "m", .min = 1e-6, .max = 10, .doc = "Radius of the loop"})
        .add("turns", &Params::turns, {.min = 1e-3, .max = 1e6, .doc = "Number of turns"})
        .add("wire_radius", &Params::wire_radius,
             {.unit = "m",
              .min = 1e-9,
              .max = 1,
              .doc = "Radius of the wire; inside it the field is that at its surface"})
        .check([](const Params& p) -> std::string {
          return p.wire_radius < p.radius ? "" : "wire_radius must be smaller than radius";
        })
        .validity("Not valid closer to the wire than the thickness of the winding.");
  }
  explicit Loop(const Params& p) : p_(p) {}

  void add(const axial::Places& at, const axial::Components& b) const {
    axial::add_loop(p_.radius, p_.wire_radius, p_.turns, at, b);
  }
  double clearance(double rho, double z) const {
    return std::max(0.0, norm(Vec2{rho - p_.radius, z}) - p_.wire_radius);
  }
  std::vector<Field::Stroke> outline(const Axis& axis) const { return {axis.circle(p_.radius, 0)}; }

 private:
  Params p_;
};

}  // namespace

void add_loop(FieldRegistry& r) { r.add<Coil<Loop>>(); }

}  // namespace faba
