#pragma once
#include <fmt/format.h>

#include <cmath>
#include <string>
#include <vector>

namespace faba {

/// TOML of the coils of the reference coil system (theory C4) at these angles around the sample, degrees,
/// with inward axes: solenoids of 5 mm radius, 40 mm length and 400 turns, with centres 35 mm from the
/// sample. `list` is the name of the table: "coil" in the file of a coil system, "field.coil" in a scenario.
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
