#pragma once
#include "app/scenario/parts.h"

namespace faba {

/// JSON Schema of a whole scenario file: what web forms and editors read.
Json scenario_json_schema(const Parts& parts);

}  // namespace faba
