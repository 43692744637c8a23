#pragma once
#include <cstdint>
#include <vector>

namespace faba {

/// A run of pixels in a row, [first, end), and the number of its connected component.
struct ComponentRun {
  int row, first, end, patch;
};

/// Connected components (8-connectivity) of a mask of width x height pixels. `runs`: all runs of non-zero
/// pixels, row by row. Components are numbered from 0 in the order of their first pixels; returns their
/// number. The mask is read once, no label image is written: the cost depends on the number of runs.
int connected_components(const std::vector<std::uint8_t>& mask, int width, int height,
                         std::vector<ComponentRun>& runs);

}  // namespace faba
