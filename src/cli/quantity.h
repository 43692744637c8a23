#pragma once
#include <string>

namespace faba::cli {

/// The value in SI of an option's words such as "50 mA", which must be finite and measure what `unit` does,
/// or be a number in SI, as in scenarios. Throws Error(usage, option) that shows `example`.
double quantity_of(const std::string& words, const char* unit, const std::string& option,
                   const std::string& example);

}  // namespace faba::cli
