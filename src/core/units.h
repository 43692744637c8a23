#pragma once
#include <array>
#include <cstdint>
#include <string>
#include <string_view>

namespace faba {

/// One degree in radians.
inline constexpr double kDegree = 3.14159265358979323846 / 180;
/// One radian in degrees.
inline constexpr double kDegreesPerRadian = 180 / 3.14159265358979323846;

/// Exponents of metre, kilogram, second, ampere, kelvin, mole and pixel. Angles are dimensionless (radian).
struct Dimension {
  std::array<std::int8_t, 7> exponent{};
  friend bool operator==(const Dimension&, const Dimension&) = default;
};

/// A value in SI (pixels are not converted) and its dimension.
struct Quantity {
  double value = 0;
  Dimension dimension;
  bool bare = false;  ///< a number without a unit
};

/// Reads "186 um/s", "23 uT", "1e-15 A m^2", "1/(T s)", "30 deg", "12 px", or a bare number (dimensionless).
/// Decimal prefixes f p n u(µ) m c k M G. Throws std::invalid_argument with one line that gives the reason.
Quantity parse_quantity(std::string_view text);

/// Dimension of a unit such as "um/s"; the factor to SI is in `value`. Throws std::invalid_argument.
Quantity parse_unit(std::string_view unit);

/// Name of the dimension ("length", "speed", "magnetic field"); "quantity in" with its SI unit if it has
/// none.
std::string dimension_name(const Dimension& d);

/// Shortest text that parses to the same number: "0.000186 m/s"; without a unit if `unit` is empty.
std::string format_quantity(double in_si, std::string_view unit);

}  // namespace faba
