#include "app/scenario/sections/simulation.h"

namespace faba {

Schema<SimulationParams> SimulationParams::schema() {
  return Schema<SimulationParams>("simulation", "Numerics")
      .add("step", &SimulationParams::step,
           {.unit = "s",
            .min = 1e-7,
            .max = 10,
            .doc = "Time step, a whole part of a frame; chosen from the models' accuracy when absent"});
}

}  // namespace faba
