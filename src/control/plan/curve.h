#pragma once
#include <span>
#include <string_view>
#include <vector>

#include "core/vec.h"

namespace faba {

/// A curve of straight segments, with positions given by the length along it. Any unit of length.
class Curve {
 public:
  /// At least one point; consecutive equal points count once.
  explicit Curve(std::span<const Vec2> points);

  double length() const { return at_.back(); }
  const std::vector<Vec2>& points() const { return points_; }
  /// The point at a length from the start, which is limited to [0, length()].
  Vec2 at(double s) const;
  /// The length in [from, to] whose point is nearest to `p`; the smallest of them if there are several.
  double nearest(Vec2 p, double from, double to) const;

 private:
  std::size_t segment(double s) const;  ///< index of its first point
  std::vector<Vec2> points_;
  std::vector<double> at_;  ///< length from the start to each point
};

/// Points of a smooth curve through all `points` (centripetal Catmull-Rom spline, which has no loops or cusps
/// within a segment), at most `step` apart. `closed`: it returns to the first point.
std::vector<Vec2> spline_through(std::span<const Vec2> points, bool closed, double step);

/// The lemniscate of Gerono (a figure of eight) with this centre, width `size` and height `size` / 2; from
/// the centre back to it. y points down.
std::vector<Vec2> figure_eight(Vec2 centre, double size, double step);
/// A circle of diameter `size`, from its rightmost point, clockwise in the image.
std::vector<Vec2> circle(Vec2 centre, double size, double step);

/// The characters that text_outline() has: A to Z, 0 to 9, space and hyphen.
inline constexpr std::string_view kOutlineCharacters = "ABCDEFGHIJKLMNOPQRSTUVWXYZ0123456789 -";
/// One continuous stroke through the letters of `text`, of width `size` in total, with this centre; y points
/// down. Letters are joined by straight lines. Lower-case letters are drawn as capitals.
std::vector<Vec2> text_outline(std::string_view text, Vec2 centre, double size);

}  // namespace faba
