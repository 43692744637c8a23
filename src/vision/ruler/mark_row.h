#pragma once
#include <map>
#include <optional>
#include <vector>

#include "core/vec.h"
#include "vision/image/image.h"
#include "vision/ruler/rotated_picture.h"
#include "vision/ruler/ruler_search.h"

namespace faba {

/// One measured mark of a row.
struct RowMark {
  int index = 0;              ///< index along the row; undetected marks are omitted
  double s = 0;               ///< position along the row, px from the picture centre: mean over the strips
  double residual_px = 0;     ///< residual of the linear fit
  bool used = true;           ///< false for outliers, which are excluded from the fit
  Vec2 from_image, to_image;  ///< ends of the measured part
};

/// A row of parallel equidistant marks with the linear fit position = offset + pitch * index.
struct MarkRow {
  double angle = 0;  ///< rad, direction across the marks, from the x axis of the picture towards its y axis
  double pitch_px = 0;
  double se_pitch_px = 0;  ///< standard error; includes correlated residuals along the row and a distortion
                           ///< of 0.02 px from end to end by shading (assumed)
  double residual_px = 0;  ///< standard deviation of the residuals
  double width_px = 0;     ///< width of a mark at half its contrast
  bool dark = true;        ///< dark marks on bright background
  double height_px = 0;    ///< length of the measured part of the marks
  double area_px = 0;      ///< supporting area: readings times strip height times pitch
  double complete =
      0;  ///< fraction of the marks from the first to the last, over all strips, that were detected
  std::vector<RowMark> marks;  ///< in order

  int used() const;  ///< number of marks in the fit
};

/// Measures rows of marks in one picture, which must outlive the object.
class RowMeter {
 public:
  explicit RowMeter(const GrayF& picture) : picture_(picture) {}

  /// Measures the marks at a hint. The marks are traced from the position of the strongest periodicity in
  /// both directions, across up to three missing ones, and then followed from strip to strip along their
  /// length while at least half of them are detected; this gives the angle. Three passes are made, each with
  /// the angle and pitch of the previous one. Marks with residuals above 4 standard deviations are excluded.
  /// Empty when fewer than four marks are in a row.
  std::optional<MarkRow> measure(const PeriodHint& hint);

 private:
  std::optional<MarkRow> measure_marks(const PeriodHint& hint, int strip_height);
  std::optional<MarkRow> measure_positions(const PeriodHint& hint, int strip_height);
  const RotatedPicture& rotated(double angle);
  const GrayF& picture_;
  std::map<double, RotatedPicture> rotated_;  // by the angle of the hint
};

}  // namespace faba
