#pragma once
#include <string>
#include <vector>

#include "study/plot/plot.h"

namespace faba {

/// Tick positions of an axis: about `tick_count` ticks within [lo, hi], in steps of 1, 2 or 5 times a power
/// of ten. Empty unless lo < hi, both finite.
std::vector<double> tick_positions(double lo, double hi, int tick_count);

/// Renders a plot as one self-contained, scalable <svg> element without scripts and external references.
/// Light by default, dark on screens with `prefers-color-scheme: dark`. Never fails: an empty plot is an
/// empty frame with the text "no data".
std::string svg(const Plot& plot);

}  // namespace faba
