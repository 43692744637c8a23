#pragma once
#include <map>
#include <optional>
#include <vector>

#include "core/vec.h"
#include "vision/image/image.h"
#include "vision/ruler/ruler_search.h"
#include "vision/ruler/turned_picture.h"

namespace faba {

/// One mark of a row, as measured.
struct RowMark {
  int index = 0;              ///< counted along the row; marks that were not seen are left out
  double s = 0;               ///< place along the row, px from the picture's centre: mean over the strips
  double residual_px = 0;     ///< from the straight line through all places
  bool used = true;           ///< false for outliers, which the line ignores
  Vec2 from_image, to_image;  ///< ends of the part that was read
};

/// A row of parallel marks at equal distances and the straight line place = offset + pitch * index.
struct MarkRow {
  double angle = 0;  ///< rad, across the marks, from the picture's x axis towards its y axis
  double pitch_px = 0;
  double se_pitch_px = 0;  ///< standard error; allows for residuals that wander along the row, and
                           ///< for 0.02 px from end to end that shading may bring in (assumed)
  double residual_px = 0;  ///< standard deviation of the marks about the line
  double width_px = 0;     ///< of a mark, at half its contrast
  bool dark = true;        ///< dark marks on bright
  double height_px = 0;    ///< length of the part of the marks that was read
  double area_px = 0;      ///< of the picture that supports it: marks read times height of strip times pitch
  double complete = 0;     ///< share of the marks, in each strip from the first to the last, that were read
  std::vector<RowMark> marks;  ///< in order

  int used() const;  ///< number of marks that the line rests on
};

/// Measures rows of marks in one picture, which must outlive it.
class RowMeter {
 public:
  explicit RowMeter(const GrayF& picture) : picture_(picture) {}

  /// Measures the marks that a hint points at. From the place where the strip repeats best the marks are
  /// walked one by one to both sides, across up to three that cannot be seen; then they are followed from
  /// strip to strip along their length as long as half of them are there, which gives the angle; this is done
  /// three times over, at the angle and pitch found before. Marks whose place is off by more than 4 standard
  /// deviations are left out. Nothing when fewer than four marks are in a row.
  std::optional<MarkRow> measure(const PeriodHint& hint);

 private:
  std::optional<MarkRow> measure_marks(const PeriodHint& hint, int strip_height);
  std::optional<MarkRow> measure_places(const PeriodHint& hint, int strip_height);
  const TurnedPicture& turned(double angle);
  const GrayF& picture_;
  std::map<double, TurnedPicture> turned_;  // by the angles of hints, which are few
};

}  // namespace faba
