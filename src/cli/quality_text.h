#pragma once
#include <vector>

#include "study/quality/quality.h"

namespace faba::cli {

/// Prints the quality of a measurement, after a name of `width` characters, and its warnings to standard
/// error.
void print_quality(const std::vector<Warning>& warnings, int width = 9);

}  // namespace faba::cli
