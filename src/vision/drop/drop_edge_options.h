#pragma once
#include <cstdint>
#include <string>

#include "vision/drop/edge_segments.h"

namespace faba {

/// Side of the edge on which the drop is.
enum class DropSide {
  automatic,  ///< the side of the circle centre, unless cells are detected on the other side only
  centre,     ///< the side of the circle centre
  away        ///< the other side: the picture shows an air bubble in the liquid
};

/// Parameters of find_drop_edge. Lengths in px of the input picture.
struct DropEdgeOptions {
  /// Smoothing, threshold, Hough lines. In coarser pyramid levels the lengths are scaled, and thresholds
  /// other than otsu are replaced by EdgeThreshold::noise.
  EdgeSegmentOptions edges;
  double stretch_low = 0.001;   ///< fraction of pixels mapped to black; pictures are stretched to 0..255
  double stretch_high = 0.999;  ///< fraction of pixels below white
  double hot_pixel_sd =
      8;  ///< pixels that differ from their 3x3 median by more noise sd are replaced by it; 0: off
  double flatten_px = 33;  ///< side of the square whose mean is subtracted before edge detection; 0: off
  int halvings = 4;        ///< maximum number of pyramid levels below full resolution
  int trials = 20000;      ///< random triples of edge pixels per pyramid level
  std::uint64_t seed = 1;  ///< seed of RANSAC
  double min_radius_fraction = 0.08;     ///< minimum radius as a fraction of the smaller side of the picture
  double min_arc_deg = 10;               ///< minimum arc; the radius of shorter arcs is not reliable
  double max_relative_sd = 0.15;         ///< maximum sd / radius
  double min_support = 0.65;             ///< minimum fraction of the visible arc with a detected edge
  double max_log10_false_alarms = -4.5;  ///< maximum log10 of the number of false alarms
  double min_contrast_steps = 2;         ///< minimum contrast in grey steps if noise does not mask the steps
  DropSide side = DropSide::automatic;
  std::string name = "drop edge";  ///< place named in errors: the file name of the picture
};

}  // namespace faba
