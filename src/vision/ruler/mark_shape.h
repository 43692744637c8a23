#pragma once
#include <span>
#include <vector>

namespace faba {

/// Grey profile along a ruler with 1 px spacing. NaN outside the picture.
struct MarkProfile {
  double first_s = 0;        ///< position of the first value
  std::vector<double> raw;   ///< grey of the picture
  std::vector<double> flat;  ///< raw minus its local mean over two pitches

  MarkProfile(double first, std::vector<double> grey, double pitch_px);
};

/// Mean shape of the marks: a sum of harmonics of the pitch, as many as the pixels resolve (at most 20).
class MarkShape {
 public:
  /// Folds the flat profiles at the mark positions `at` (one list for each profile), half a pitch to each
  /// side.
  MarkShape(std::span<const MarkProfile> profiles, std::span<const std::vector<double>> at, double pitch_px);

  /// Grey at a distance from the mark position.
  double grey(double offset_px) const { return look_up(grey_, offset_px); }
  double slope(double offset_px) const {
    return look_up(slope_, offset_px);
  }  ///< derivative of grey(), per px
  /// Whether the marks are dark on bright: the dark part is less than half of a pitch.
  bool dark() const { return dark_; }
  double range() const { return range_; }          ///< grey range, maximum minus minimum
  double width_px() const { return width_px_; }    ///< width at half height, at most half a pitch
  double centre_px() const { return centre_px_; }  ///< centre of the mark relative to the folding position

 private:
  double look_up(const std::vector<double>& table, double offset_px) const;
  void tabulate(std::span<const double> cosines, std::span<const double> sines);
  void describe();
  double pitch_px_;
  std::vector<double> grey_, slope_;  // one pitch in equal steps; the first value is repeated at the end
  bool dark_ = true;
  double range_ = 0, width_px_ = 0, centre_px_ = 0;
};

/// Result of read_mark.
struct MarkReading {
  bool found = false;   ///< true: matches the mean shape
  double shift_px = 0;  ///< position of the mark minus the expected position
  double size = 0;      ///< contrast relative to the mean shape
};

/// Least-squares fit of shape(s - at - shift) * size + level + slope * s to the raw profile over one pitch
/// around `at` (no slope below a pitch of 6 px). Only this interval is used, because the first and last marks
/// have different surroundings. A mark is detected when its correlation with the shape exceeds 0.5, its shift
/// is below 0.3 pitches, its size is between 0.25 and 4, and the background slope is below half of its size.
MarkReading read_mark(const MarkProfile& profile, double at, double pitch_px, const MarkShape& shape);

}  // namespace faba
