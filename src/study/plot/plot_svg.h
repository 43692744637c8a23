#pragma once
#include <string>
#include <vector>

#include "study/plot/plot.h"

namespace faba {

/// Positions of the ticks of a scale: 1, 2 or 5 times a power of ten apart, about `wanted` of them inside
/// [lo, hi]. Empty unless lo < hi, both finite.
std::vector<double> tick_positions(double lo, double hi, int wanted);

/// The drawing as one self-contained <svg> element: no script, no reference to anything outside. Light by
/// itself, dark where the reader's system asks for it (`prefers-color-scheme`, on screens only), and free to
/// be scaled. Never fails: an empty plot is an empty frame that says "no data".
std::string svg(const Plot& plot);

}  // namespace faba
