#pragma once
#include "app/scenario/parts.h"
#include "rig/setup/rig_setup.h"

namespace faba {

/// JSON Schema of [rig]: the bench, its camera and its coil driver.
Json rig_json_schema(const Parts& parts);

}  // namespace faba
