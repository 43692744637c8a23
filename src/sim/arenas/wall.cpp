#include "sim/arenas/wall.h"

namespace faba {

WallAlignment::WallAlignment(State& s, double rate, double dt) {
  if (rate == 0 || !s.agents.has("ux")) return;
  ux_ = s.agents["ux"];
  uy_ = s.agents["uy"];
  turn_ = float(rate * dt);
}

FieldInfo WallAlignment::field_info() {
  return {.unit = "1/s",
          .min = 0,
          .max = 1000,
          .doc = "Rate at which a wall turns cells that push against it to swim along it",
          .source = "assumed 0: not measured for these cells (B6)"};
}

}  // namespace faba
