#include "study/identify/u_turn.h"

#include <cmath>
#include <limits>
#include <numbers>

#include "core/constants.h"
#include "study/identify/free_parameter.h"

namespace faba {

double u_turn_s(const Json& model, double moment, double field_t) {
  const Json scenario{{"swarm", {{{"model", model}}}}};
  const auto of = [&](const char* name) {
    return scenario_number(std::string("swarm[0].model.") + name, scenario).value_or(std::nan(""));
  };
  const double drag = of("drag_factor") * 8 * std::numbers::pi * of("viscosity") * std::pow(of("radius"), 3);
  const double energy = moment * field_t, thermal_energy = kBoltzmann * of("temperature");
  if (!(4 * energy > thermal_energy)) return std::numeric_limits<double>::infinity();
  return drag / energy * std::log(4 * energy / thermal_energy);
}

}  // namespace faba
