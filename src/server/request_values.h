#pragma once
#include <cstdint>
#include <optional>
#include <string>

#include "core/toml.h"
#include "server/web_handlers.h"

namespace faba {

/// The JSON object in the body of a request. Throws Error(usage).
Json body_of(const WebRequest& r);

/// A value of the query; empty if it is not given.
std::string query_text(const WebRequest& r, const char* key);
/// A finite number, or an integer from 0, of the query; `fallback` if it is not given. Throw Error(usage)
/// with the key.
double query_number(const WebRequest& r, const char* key, double fallback);
std::uint64_t query_count(const WebRequest& r, const char* key, std::uint64_t fallback);

/// A number, or an integer, within limits; without a `fallback` it must be given. Throw Error(usage) with the
/// key.
double number_of(const Json& asked, const char* key, double least, double most,
                 std::optional<double> fallback = {});
std::uint64_t count_of(const Json& asked, const char* key, std::uint64_t least, std::uint64_t most,
                       std::optional<std::uint64_t> fallback = {});

/// A text that is not empty. Throws Error(usage) with the key.
std::string text_of(const Json& asked, const char* key);

/// The name of an imported file in messages, from `name`, without its folder: files that the scenario refers
/// to are not searched there. "file" without a name.
std::string file_name_of(const Json& asked);

}  // namespace faba
