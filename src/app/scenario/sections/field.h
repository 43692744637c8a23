#pragma once
#include "app/scenario/parts.h"

namespace faba {

/// JSON Schema of [field]: a part; a coil system may also be given by the key `file`, which include_rig()
/// replaces.
Json field_json_schema(const Parts& parts);

}  // namespace faba
