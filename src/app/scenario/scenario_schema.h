#pragma once
#include "app/scenario/parts.h"

namespace faba {

/// JSON Schema of a complete scenario file, for web forms and editors.
Json scenario_json_schema(const Parts& parts);

}  // namespace faba
