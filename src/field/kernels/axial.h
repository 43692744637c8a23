#pragma once
#include <span>

/// Fields of coaxial currents, the components of loops, solenoids and thick coils. Cylindrical coordinates:
/// rho from the axis, z along it, m. Results are added to `b_rho` and `b_z`. Formulas: theory C1 and C2.
namespace faba::axial {

inline constexpr double kMu0 = 1.25663706127e-6;  ///< T m/A, CODATA 2022

struct Places {
  std::span<const double> rho, z;  ///< rho >= 0
};
struct Components {
  std::span<double> rho, z;  ///< T
};

/// A circular loop of radius a at z = 0 with `current` A. Within `wire_radius` of the wire the field is that
/// at its surface.
void add_loop(double a, double wire_radius, double current, const Places& at, const Components& b);

/// A cylindrical current sheet of radius a from z = -half to half with `sheet` A/m: the winding of a
/// solenoid. On the sheet the field is the mean of both sides; at its two rims, where it diverges, distances
/// are at least `wire_radius`.
void add_sheet(double a, double half, double wire_radius, double sheet, const Places& at,
               const Components& b);

}  // namespace faba::axial
