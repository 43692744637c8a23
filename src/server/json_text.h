#pragma once
#include <string>

#include "core/toml.h"

namespace faba {

/// JSON for a page. Names of files, and errors with such a name, need not be UTF-8: bytes that are not are
/// replaced, because dump() would throw.
inline std::string json_text(const Json& j) { return j.dump(-1, ' ', false, Json::error_handler_t::replace); }

}  // namespace faba
