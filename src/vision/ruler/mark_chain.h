#pragma once
#include <map>
#include <vector>

#include "vision/ruler/mark_shape.h"
#include "vision/ruler/turned_picture.h"

namespace faba {

constexpr int kLeastMarks = 4;  ///< fewer are no row

/// Places of the marks along one strip, by index: s of the turned frame, px. Indices may leave gaps.
using MarkChain = std::map<int, double>;

/// One mark in one strip, as read.
struct StripReading {
  int index;         ///< as in the chain
  double s, t;       ///< turned frame, px; t is the strip's middle
  bool used = true;  ///< false for outliers
};

/// What was read in a row of strips, and how much there was to read.
struct StripReadings {
  std::vector<StripReading> list;
  int possible = 0;  ///< marks of the chain that lie in the picture, summed over the strips
};

/// Slope of a straight line through a chain's places: the pitch, px. Needs two marks.
double mean_gap(const MarkChain& chain);

/// Finds the marks of one strip: from the place where it swings most strongly and purely at the pitch they
/// are walked one by one to both sides, each looked for where the last ones lead, across up to three that
/// cannot be seen. Places are those of the marks' middles. Empty when fewer than kLeastMarks are found, or
/// when their distance is not what was said to 15 %.
MarkChain walk_marks(const MarkProfile& profile, double pitch_px);

/// Reads a chain's marks again on the strips below each other from t on (`step` 1) or above each other (-1),
/// as long as half of those in the picture are there, across gaps of half a pitch. Each strip is looked at
/// where the one before left off, so that leaning marks are followed.
void follow_marks(const TurnedPicture& turned, const MarkChain& chain, double pitch_px,
                  const MarkShape& shape, double t, int step, int strip_height, StripReadings& out);

}  // namespace faba
