#pragma once
#include <string_view>

#include "core/toml.h"

namespace faba {

/// JSON from outside of the program. Documents are copied and processed recursively, so their depth is
/// limited: is_discarded() for text that is invalid or nested deeper than 64 levels.
Json parse_json(std::string_view text);

}  // namespace faba
