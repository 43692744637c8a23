#pragma once
#include <cstddef>

#include "vision/foreground/background.h"
#include "vision/image/image.h"

namespace faba {

/// Removes stationary cells from a background: spots darker (or brighter) than their surroundings
/// that are not much longer than a cell in any direction are filled with the grey value of their
/// surroundings. Lines, such as the edge of a drop, stay, also where a cell lies on them. Dirt of the size of
/// a cell is removed as well. `cell_px`: width of a cell at half its contrast; `contrast`: difference of a
/// cell from the background in units of `light`. Returns the number of spots.
std::size_t remove_stationary_cells(GrayF& light, double cell_px, double contrast, Polarity polarity);

}  // namespace faba
