#pragma once
#include <string>

#include "core/toml.h"
#include "server/web_handlers.h"

namespace faba {

/// The JSON object in the body of a request. Throws Error(usage).
Json body_of(const WebRequest& r);

/// A text that is not empty. Throws Error(usage) with the key.
std::string text_of(const Json& asked, const char* key);

/// The name of an imported file in messages, from `name`, without its folder: files that the scenario refers
/// to are not searched there. "file" without a name.
std::string file_name_of(const Json& asked);

}  // namespace faba
