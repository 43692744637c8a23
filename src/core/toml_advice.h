#pragma once
#include <string>
#include <string_view>

namespace faba {

/// Message for an error that toml++ found in `line`: its `reason`, with advice for frequent errors.
std::string toml_advice(std::string_view reason, std::string_view line);

}  // namespace faba
