#pragma once
#include <map>
#include <vector>

#include "vision/ruler/mark_shape.h"
#include "vision/ruler/rotated_picture.h"

namespace faba {

constexpr int kMinMarks = 4;  ///< minimum number of marks in a row

/// Positions of the marks along one strip, by index: s of the rotated frame, px. Indices may have gaps.
using MarkChain = std::map<int, double>;

/// Position of one mark in one strip.
struct StripReading {
  int index;         ///< as in the chain
  double s, t;       ///< rotated frame, px; t is the centre of the strip
  bool used = true;  ///< false for outliers
};

/// Positions read in a series of strips, and their expected number.
struct StripReadings {
  std::vector<StripReading> list;
  int expected = 0;  ///< number of marks of the chain inside the picture, summed over the strips
};

/// Pitch of a chain, px: slope of the straight line through its positions. Needs two marks.
double mean_gap(const MarkChain& chain);

/// Detects the marks of one strip. The trace starts where the component at the pitch is strongest and purest,
/// and continues mark by mark in both directions, predicted from the previous marks, across up to three
/// missing marks. Positions are the centres of the marks. Empty when fewer than kMinMarks are found, or when
/// their pitch differs by more than 15 % from `pitch_px`.
MarkChain trace_marks(const MarkProfile& profile, double pitch_px);

/// Reads the marks of a chain again in consecutive strips from t downwards (`step` 1) or upwards (-1), while
/// at least half of the marks inside the picture are detected, across gaps of half a pitch. The offset of
/// each strip is carried to the next, so that inclined marks are followed.
void follow_marks(const RotatedPicture& rotated, const MarkChain& chain, double pitch_px,
                  const MarkShape& shape, double t, int step, int strip_height, StripReadings& out);

}  // namespace faba
