#pragma once
#include <string>
#include <vector>

#include "study/plot/plot.h"

namespace faba {

/// Tick positions of an axis: about `tick_count` ticks within [lo, hi], in steps of 1, 2 or 5 times a power
/// of ten, of at least 1 with Ticks::integers; with Ticks::degrees at most `tick_count` + 1 ticks in steps of
/// 45, 90, 180 or 360, or of 1, 5 or 15 in a small range. Empty unless lo < hi, both finite.
std::vector<double> tick_positions(double lo, double hi, int tick_count, Ticks ticks = Ticks::numbers);

/// Whether a plot shows at least one value.
bool has_values(const Plot& plot);

/// Renders a plot as one self-contained, scalable <svg> element without scripts and external references.
/// Light by default, dark on screens with `prefers-color-scheme: dark`. Never fails: an empty plot is an
/// empty frame with the text "no data".
std::string svg(const Plot& plot);

}  // namespace faba
