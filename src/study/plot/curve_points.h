#pragma once
#include <vector>

#include "study/plot/plot.h"
#include "study/plot/plot_map.h"

namespace faba::drawing {

/// The points of a curve that are drawn, in sections without a gap, each with its index in the curve. Points
/// outside the range of x are dropped, except the neighbours of visible points; a long section is thinned to
/// the resolution of the drawing and keeps the minimum and maximum of every pixel column. No section is
/// empty.
std::vector<std::vector<PlotPoint>> curve_sections(const Line& line, const Map& map);

}  // namespace faba::drawing
