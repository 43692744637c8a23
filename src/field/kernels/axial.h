#pragma once
#include <span>

/// Fields of currents that run round an axis: what loops, solenoids and thick coils are made of. Cylindrical
/// coordinates: rho from the axis, z along it, m. `b_rho` and `b_z` are added to. Formulas: theory C1 and C2.
namespace faba::axial {

inline constexpr double kMu0 = 1.25663706127e-6;  ///< T m/A, CODATA 2022

struct Places {
  std::span<const double> rho, z;  ///< rho >= 0
};
struct Components {
  std::span<double> rho, z;  ///< T
};

/// A circular loop of radius a at z = 0 with `current` A. Nearer to the wire than `wire_radius` the field is
/// that at its surface.
void add_loop(double a, double wire_radius, double current, const Places& at, const Components& b);

/// A cylindrical current sheet of radius a from z = -half to half with `sheet` A/m: a solenoid's winding. On
/// the sheet itself it is the mean of both sides; at its two rims, where it has no limit, distances are not
/// less than `wire_radius`.
void add_sheet(double a, double half, double wire_radius, double sheet, const Places& at,
               const Components& b);

}  // namespace faba::axial
