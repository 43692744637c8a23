#include "control/controller.h"
#include "field/allocate.h"

namespace faba {

Command drive_command(const ControlContext& c, Vec2 at_world, Vec2 drive) {
  return {allocate(*c.field, {at_world.x, at_world.y, 0}, (c.polarity * c.scale.field_unit) * drive)};
}

}  // namespace faba
