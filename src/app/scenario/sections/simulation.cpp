#include "app/scenario/sections/simulation.h"

namespace faba {

Schema<SimulationParams> SimulationParams::schema() {
  return Schema<SimulationParams>("simulation", "Numerics")
      .add("step", &SimulationParams::step,
           {.unit = "s",
            .min = 1e-7,
            .max = 10,
            .doc = "Time step, which must divide the frame period; default: chosen for the accuracy of the "
                   "models"});
}

}  // namespace faba
