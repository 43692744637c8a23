#pragma once
#include <vector>

#include "core/vec.h"

namespace faba {

/// A position with its weight (number of cells, or signal); any unit of length.
struct WeightedPosition {
  Vec2 at;
  double weight = 1;
};

/// A cluster; lengths in the unit of the positions.
struct FuzzyGroup {
  Vec2 centroid;
  Mat2 cov;
  double share = 0;  ///< fraction of the total weight: sum of memberships
};

/// Parameters of fuzzy_groups.
struct FuzzyGroupOptions {
  int count = 0;              ///< number of groups; 0: estimated, 1 to `most`
  int most = 4;               ///< maximum number of groups, 1 to 10
  double least_share = 0.03;  ///< minimum fraction of the total weight in a group
  /// Two groups are separate only if their distance exceeds this multiple of their dispersion along the
  /// connecting line. Two halves of a uniform distribution have 3.5, of a Gaussian 2.7 (theory H6).
  double separation = 4.5;
};

/// Membership of a position in each group, 0 to 1, sum 1: proportional to the inverse squared distances
/// (fuzzy c-means with fuzzifier 2, theory H6). At a centroid the membership of its group is 1.
std::vector<double> memberships(const std::vector<FuzzyGroup>& groups, Vec2 at);

/// Fuzzy c-means clustering (Bezdek) of weighted positions. If the number of groups is not given, every
/// number up to `most` is tried, starting with one group and splitting the widest one along its main axis;
/// among those whose groups are all separate, the index of Xie and Beni decides; otherwise the result is one
/// group. Groups are sorted by weight, largest first. Portable arithmetic: bit-identical for the same input.
/// Empty if the total weight is 0.
std::vector<FuzzyGroup> fuzzy_groups(const std::vector<WeightedPosition>& positions,
                                     const FuzzyGroupOptions& options = {});

/// Bins the positions on a grid of at most `cells` x `cells` squares over their bounding box: one weighted
/// mean position for each occupied square.
std::vector<WeightedPosition> binned(const std::vector<WeightedPosition>& positions, int cells);

}  // namespace faba
