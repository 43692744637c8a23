#include "cli/quality_text.h"

#include <fmt/format.h>

#include "cli/command_line.h"

namespace faba::cli {

void print_quality(const std::vector<Warning>& warnings, int width) {
  fmt::print("{:<{}}{}\n", "quality", width, word_of(quality_of(warnings)));
  for (const Warning& w : warnings) print_stderr("faba: warning: " + sentence(w));
}

}  // namespace faba::cli
