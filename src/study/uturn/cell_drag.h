#pragma once

namespace faba {

/// Rotational drag of a prolate ellipsoid about an axis across its length, N m s: `length` and `width` are
/// its full axes, m, length >= width; `viscosity` in Pa s. 8 pi eta R^3 for a sphere. Source: Perrin, J.
/// Phys. Radium 5:497 (1934).
double rotational_drag(double length, double width, double viscosity);

}  // namespace faba
