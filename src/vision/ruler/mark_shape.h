#pragma once
#include <span>
#include <vector>

namespace faba {

/// Grey along a ruler, 1 px apart. NaN where there is no picture.
struct MarkProfile {
  double first_s = 0;        ///< place of the first value
  std::vector<double> raw;   ///< as in the picture
  std::vector<double> flat;  ///< without the mean over two pitches about each place, which carries no marks

  MarkProfile(double first, std::vector<double> grey, double pitch_px);
};

/// What one mark looks like: a sum of harmonics of the pitch, as many as pixels can show (at most 20).
class MarkShape {
 public:
  /// Folds the flat profiles at the marks' places `at` (one list for each profile), half a pitch to each
  /// side.
  MarkShape(std::span<const MarkProfile> profiles, std::span<const std::vector<double>> at, double pitch_px);

  double grey(double offset_px) const {
    return look_up(grey_, offset_px);
  }  ///< this far from the mark's place
  double slope(double offset_px) const { return look_up(slope_, offset_px); }  ///< its derivative, per px
  /// Whether the marks are dark on bright: they take up less than half of a pitch.
  bool dark() const { return dark_; }
  double range() const { return range_; }          ///< grey, from its lowest to its highest
  double width_px() const { return width_px_; }    ///< at half the height, at most half a pitch
  double centre_px() const { return centre_px_; }  ///< middle of the mark, from the place that was folded at

 private:
  double look_up(const std::vector<double>& table, double offset_px) const;
  void tabulate(std::span<const double> cosines, std::span<const double> sines);
  void describe();
  double pitch_px_;
  std::vector<double> grey_, slope_;  // one pitch in even steps, the first value once more at the end
  bool dark_ = true;
  double range_ = 0, width_px_ = 0, centre_px_ = 0;
};

/// What was read of one mark.
struct MarkReading {
  bool there = false;   ///< looks like the others
  double shift_px = 0;  ///< of the mark from where it was looked for
  double size = 0;      ///< contrast over that of the shape
};

/// Fits shape(s - at - shift) * size + level + slope * s to the raw profile over the pitch about `at` by
/// least squares (no slope below a pitch of 6 px). Nothing but the mark itself is looked at, for the first
/// and the last one have other surroundings than the rest. A mark is there when it correlates with the shape
/// by more than a half, lies within 0.3 pitches, is a quarter to four times as strong, and stands on ground
/// that slopes by less than half of that.
MarkReading read_mark(const MarkProfile& profile, double at, double pitch_px, const MarkShape& shape);

}  // namespace faba
