#pragma once
#include "app/scenario/parts.h"

namespace faba {

/// JSON Schema of [field]: a part, where a coil system may also be given as a file of its own, which
/// include_rig() puts in the key's place.
Json field_json_schema(const Parts& parts);

}  // namespace faba
