#include "control/controller.h"
#include "field/allocate.h"

namespace faba {

Vec2 error_px(const ControlContext& c, const Estimate& e, const Target& target) {
  return (1 / c.scale.m_per_px) * (target.position - e.centroid);
}

Command field_command(const ControlContext& c, Vec2 at_world, Vec2 u) {
  return {allocate(*c.field, {at_world.x, at_world.y, 0}, (c.polarity * c.scale.field_unit) * u)};
}

}  // namespace faba
