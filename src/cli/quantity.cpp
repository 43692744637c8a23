#include "cli/quantity.h"

#include <fmt/format.h>

#include <cmath>
#include <stdexcept>

#include "core/error.h"
#include "core/units.h"

namespace faba::cli {

double quantity_of(const std::string& words, const char* unit, const std::string& option,
                   const std::string& example) {
  std::string why = fmt::format("\"{}\" is not in {}", words, unit);
  try {
    const Quantity q = parse_quantity(words);
    const bool fits = q.bare || q.dimension == parse_unit(unit).dimension;
    if (fits && std::isfinite(q.value)) return q.value;
  } catch (const std::invalid_argument& e) {
    why = e.what();
  }
  throw Error(Errc::usage, option, fmt::format("{}; write it such as \"{}\"", why, example));
}

}  // namespace faba::cli
