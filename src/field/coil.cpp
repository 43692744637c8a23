#include "field/coil.h"

#include "core/portable_math.h"

namespace faba {
Schema<CircuitParams> CircuitParams::schema() {
  return Schema<CircuitParams>("circuit", "Electrical circuit of a coil")
      .add("name", &CircuitParams::name, {.doc = "Name of the coil in reports"})
      .add("gain", &CircuitParams::gain,
           {.min = -1e3,
            .max = 1e3,
            .doc = "Ratio of the measured field to the calculated field, as determined by `faba field fit`",
            .role = Role::strength})
      .add("current", &CircuitParams::current,
           {.unit = "A",
            .min = -1e4,
            .max = 1e4,
            .doc = "Default current, used where no current is commanded, as in `faba field`"})
      .add("max_current", &CircuitParams::max_current,
           {.unit = "A", .min = 0, .max = 1e4, .doc = "Maximum current; default: unlimited"})
      .add("resistance", &CircuitParams::resistance,
           {.unit = "ohm", .min = 1e-6, .max = 1e6, .doc = "Resistance of the winding"})
      .add("inductance", &CircuitParams::inductance,
           {.unit = "H",
            .min = 0,
            .max = 1e3,
            .doc = "Inductance; requires resistance; the current lags its command with time constant L/R",
            .source = "L/R of 1-10 ms is typical (C4)"})
      .check([](const CircuitParams& p) -> std::string {
        if (p.inductance && !p.resistance)
          return "inductance requires resistance, for the time constant L/R; specify both";
        if (p.max_current && std::fabs(p.current) > *p.max_current)
          return "current must not exceed max_current";
        return {};
      });
}

Circuit CircuitParams::circuit() const {
  Circuit c;
  c.name = name;
  c.current = current;
  if (max_current) c.max_current = *max_current;
  c.resistance = resistance.value_or(0);
  if (inductance && resistance) c.lag = *inductance / *resistance;
  return c;
}

Schema<PoseParams> PoseParams::schema() {
  return Schema<PoseParams>("pose", "Position and orientation of a coil")
      .add("position", &PoseParams::position,
           {.unit = "m",
            .min = -10,
            .max = 10,
            .doc = "Centre, world frame: x right, y up, z towards the camera",
            .role = Role::position})
      .add("axis", &PoseParams::axis,
           {.min = -1e6,
            .max = 1e6,
            .doc = "Direction of the field in the coil for a positive current; its length is ignored",
            .role = Role::axis})
      .check([](const PoseParams& p) -> std::string {
        return p.axis == Vec3{} ? "axis must not be [0, 0, 0]" : "";
      });
}

Axis::Axis(Vec3 origin, Vec3 direction) : origin_(origin), direction_((1 / norm(direction)) * direction) {
  // Any two perpendicular directions; starting from the axis least parallel to the coil's avoids
  // cancellation.
  const Vec3 d{std::fabs(direction_.x), std::fabs(direction_.y), std::fabs(direction_.z)};
  const Vec3 other = d.x <= d.y && d.x <= d.z ? Vec3{1, 0, 0} : d.y <= d.z ? Vec3{0, 1, 0} : Vec3{0, 0, 1};
  across_ = cross(direction_, other);
  across_ = (1 / norm(across_)) * across_;
  third_ = cross(direction_, across_);
}

void Axis::cylindrical(std::span<const Vec3> at, std::span<double> rho, std::span<double> z) const {
  for (std::size_t i = 0; i < at.size(); ++i) {
    const Vec3 r = at[i] - origin_;
    z[i] = dot(r, direction_);
    rho[i] = norm(r - z[i] * direction_);
  }
}

Vec3 Axis::vector(Vec3 at, double b_rho, double b_z) const {
  const Vec3 r = at - origin_, off = r - dot(r, direction_) * direction_;
  const double rho = norm(off);
  return rho > 0 ? b_z * direction_ + (b_rho / rho) * off : b_z * direction_;
}

Field::Stroke Axis::circle(double radius, double z) const {
  constexpr int kCorners = 96;
  Field::Stroke s;
  for (int i = 0; i <= kCorners; ++i) {
    const double turn = 2 * portable::kPi * i / kCorners;
    s.push_back(line(radius, turn, z, z).front());
  }
  return s;
}

Field::Stroke Axis::line(double rho, double turn, double z0, double z1) const {
  const auto a = portable::sincos(turn);
  const Vec3 off = (rho * a.cos) * across_ + (rho * a.sin) * third_;
  return {origin_ + off + z0 * direction_, origin_ + off + z1 * direction_};
}

}  // namespace faba
