#pragma once
#include <vector>

#include "core/vec.h"

namespace faba {

/// A place and how much of a swarm is there (cells, or signal); any unit of length.
struct WeightedPlace {
  Vec2 at;
  double weight = 1;
};

/// A group of places; lengths in the unit of the places.
struct FuzzyGroup {
  Vec2 centroid;
  Mat2 cov;
  double share = 0;  ///< of the whole weight, sum of memberships
};

/// Parameters of fuzzy_groups.
struct FuzzyGroupOptions {
  int count = 0;              ///< of groups; 0: found, 1 to `most`
  int most = 4;               ///< 1 to 10
  double least_share = 0.03;  ///< a group with less is none
  /// Two groups are two only when their distance is over this many times their spread along the line between
  /// them. Halves of one even band have 3.5, of one Gaussian 2.7 (theory H6).
  double separation = 4.5;
};

/// Membership of a place in each group, 0 to 1, sum 1: inverse squares of the distances (fuzzy c-means with
/// fuzzifier 2, theory H6). Near a centroid it is all of that one's.
std::vector<double> memberships(const std::vector<FuzzyGroup>& groups, Vec2 at);

/// Fuzzy c-means (Bezdek) of weighted places. For a number that is not given every one up to `most` is tried,
/// beginning with one group and cutting the widest in two along its main axis; those whose groups are all
/// separated are compared by the index of Xie and Beni, and when none is separated there is one group. Groups
/// come largest first. Only portable arithmetic; same places in the same order, same bits. Empty for no
/// weight.
std::vector<FuzzyGroup> fuzzy_groups(const std::vector<WeightedPlace>& places,
                                     const FuzzyGroupOptions& options = {});

/// The same places on a grid of at most `cells` by `cells` squares over what they cover, one place for each
/// square that holds any, at the mean of its own.
std::vector<WeightedPlace> binned(const std::vector<WeightedPlace>& places, int cells);

}  // namespace faba
