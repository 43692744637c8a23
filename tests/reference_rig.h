#pragma once
#include <fmt/format.h>

#include <cmath>
#include <string>
#include <vector>

namespace faba {

/// The TOML of the reference rig's coils (theory C4) standing at these angles about the sample, in degrees,
/// axes inward: solenoids of 5 mm radius, 40 mm length and 400 turns, their middles 35 mm away. `list` is
/// what their table is called: "coil" in a rig, "field.coil" in a scenario.
inline std::string reference_coils(const std::string& list, const std::vector<double>& angles) {
  std::string t;
  for (const double a : angles) {
    const double c = std::cos(a * 3.14159265358979323846 / 180),
                 s = std::sin(a * 3.14159265358979323846 / 180);
    t += fmt::format(
        "[[{}]]\ntype = 'solenoid'\nradius = 0.005\nlength = 0.04\nturns = 400\nmax_current = 0.5\nposition "
        "= [{}, {}, "
        "0]\naxis = [{}, {}, 0]\n",
        list, 0.035 * c, 0.035 * s, -c, -s);
  }
  return t;
}

}  // namespace faba
