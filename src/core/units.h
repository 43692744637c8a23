#pragma once
#include <array>
#include <cstdint>
#include <string>
#include <string_view>

namespace faba {

/// One degree in radians.
inline constexpr double kDegree = 3.14159265358979323846 / 180;

/// Exponents of metre, kilogram, second, ampere, kelvin, mole and pixel. Angles are dimensionless (radian).
struct Dimension {
  std::array<std::int8_t, 7> exponent{};
  friend bool operator==(const Dimension&, const Dimension&) = default;
};

/// A number in SI (pixels stay pixels) and what it measures.
struct Quantity {
  double value = 0;
  Dimension dimension;
  bool bare = false;  ///< a number without a unit
};

/// Reads "186 um/s", "23 uT", "1e-15 A m^2", "1/(T s)", "30 deg", "12 px", or a bare number (dimensionless).
/// Decimal prefixes f p n u(µ) m c k M G. Throws std::invalid_argument with one line saying what is wrong.
Quantity parse_quantity(std::string_view text);

/// Dimension of a unit such as "um/s"; the factor to SI is in `value`. Throws std::invalid_argument.
Quantity parse_unit(std::string_view unit);

/// A word for the dimension where there is one ("length", "speed", "magnetic field"), else its SI unit ("kg
/// m^2/s").
std::string dimension_name(const Dimension& d);

/// Shortest text that reads back to the same number: "0.000186 m/s"; no unit when `unit` is empty.
std::string format_quantity(double in_si, std::string_view unit);

}  // namespace faba
