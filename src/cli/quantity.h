#pragma once
#include <string>

namespace faba::cli {

/// Value in SI of the text of an option, such as "50 mA": a finite quantity with the dimension of `unit`.
/// Only 0 and numbers of seconds need no unit. Throws Error(usage, option) with `example`.
double quantity_of(const std::string& text, const char* unit, const std::string& option,
                   const std::string& example);

}  // namespace faba::cli
