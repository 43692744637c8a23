// Tests that use the parts of the program use those of the engine when they are linked with the engine only.
#include "app/scenario/parts.h"

namespace faba {

const Parts& builtin_parts() {
  static const Parts parts = engine_parts();
  return parts;
}

}  // namespace faba
