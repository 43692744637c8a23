#pragma once
#include <cstddef>
#include <span>
#include <vector>

#include "vision/drop/circle_fit.h"
#include "vision/image/image.h"

namespace faba {

/// A piece of the visible arc of a circle.
struct ArcPiece {
  double angle = 0, width = 0;  ///< rad: direction of the centre, from x to y, and angle between the ends
  std::vector<double> grey;     ///< radial profile at radius - half, ..., radius + half px
  std::size_t segment = 0;      ///< index of the contiguous visible segment of the circle
  double shift = 0;  ///< position of the edge, px from the circle outward; set by the align functions
};

/// The visible arc of a circle, divided into pieces of equal length, in the order of their angles.
struct ArcStrip {
  std::vector<ArcPiece> pieces;
  bool closed = false;  ///< the complete circle is in the picture: the last piece adjoins the first
  int half = 0;         ///< half width of the profiles, px
  double piece_px = 0;  ///< length of a piece along the arc

  int reach() const { return half / 2; }  ///< range of shifts: -reach..reach
};

/// Options of read_arc_strip. Lengths in px of the picture.
struct ArcStripOptions {
  int half_width = 24;   ///< half width of the radial profiles; even
  double border_px = 6;  ///< margin at the picture border that is excluded
  double piece_px = 6;   ///< minimum length of a piece
  int max_pieces = 128;  ///< maximum number of pieces; long arcs have longer pieces
};

/// Reads the strip: grey values interpolated bilinearly every px along and across the arc; interquartile mean
/// over each piece. Positions outside the picture take the nearest border pixel. No pieces when the circle
/// does not cross the picture.
ArcStrip read_arc_strip(const GrayF& picture, const Circle& circle, const ArcStripOptions& options = {});

/// Sets each shift by template matching with the mean profile of all OTHER pieces (without linear trend),
/// normalised by the local standard deviation of grey. Makes no assumption about the edge shape, and is
/// insensitive to linear gradients of light. Sub-pixel.
void align_by_profile(ArcStrip& strip);

/// Sets each shift to the change point of mean and variance of the piece (maximum likelihood): an edge with a
/// coarse texture on one side has no common profile, but a change of statistics. Resolution half a pixel.
void align_by_change(ArcStrip& strip);

/// Mean radial profile in the given directions: element i belongs to radius + (i - half) px. Interquartile
/// mean at each radius, robust against cells and dust.
std::vector<double> mean_profile(const GrayF& picture, const Circle& circle, std::span<const double> angles,
                                 int half);

/// Subtracts mean and linear trend from v (odd length, at least 3), so that its product with any straight
/// line is 0.
void remove_line(std::vector<double>& v);

}  // namespace faba
