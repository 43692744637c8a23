#include "cli/quantity.h"

#include <fmt/format.h>

#include <cmath>
#include <stdexcept>

#include "core/error.h"
#include "core/units.h"

namespace faba::cli {

double quantity_of(const std::string& text, const char* unit, const std::string& option,
                   const std::string& example) {
  std::string reason = fmt::format("\"{}\" is not a quantity in {}", text, unit);
  try {
    const Quantity q = parse_quantity(text);
    const bool fits = q.bare || q.dimension == parse_unit(unit).dimension;
    // The other options that are times also accept a number of seconds; 0 is the same in every unit.
    const bool needs_unit =
        q.bare && q.value != 0 && !(parse_unit(unit).dimension == parse_unit("s").dimension);
    if (fits && std::isfinite(q.value) && !needs_unit) return q.value;
    if (needs_unit && std::isfinite(q.value)) reason = fmt::format("\"{}\" has no unit", text);
    if (!fits)
      reason = fmt::format("\"{}\" is a {}, not a {}", text, dimension_name(q.dimension),
                           dimension_name(parse_unit(unit).dimension));
  } catch (const std::invalid_argument& e) {
    reason = e.what();
  }
  throw Error(Errc::usage, option, fmt::format("{}; write it like \"{}\"", reason, example));
}

}  // namespace faba::cli
