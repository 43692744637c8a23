#pragma once
#include <cstdint>
#include <vector>

namespace faba {

/// A stretch of a row of pixels, from `first` to before `end`, and the patch that it is part of.
struct PatchRun {
  int row, first, end, patch;
};

/// The connected patches of a mask of width x height pixels, neighbours across corners included: `runs` is
/// every stretch of pixels that are not 0, row by row. Patches are numbered from 0 in the order of their
/// first pixels; returns how many there are. Work goes with the number of runs: the mask is read once, and no
/// picture of numbers is written.
int find_patches(const std::vector<std::uint8_t>& mask, int width, int height, std::vector<PatchRun>& runs);

}  // namespace faba
