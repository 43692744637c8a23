#pragma once
#include <cstdint>
#include <string>

#include "vision/drop/edge_segments.h"

namespace faba {

/// Which side of the edge is the drop.
enum class DropSide {
  automatic,  ///< the side holding the circle's centre, unless cells are seen on the other side only
  centre,     ///< the side holding the circle's centre
  away        ///< the other side: the picture shows an air bubble in the liquid
};

/// Parameters of find_drop_edge. Lengths in px of the picture given.
struct DropEdgeOptions {
  /// Smoothing, threshold, Hough lines. In the halved copies lengths are halved too, and a threshold other
  /// than otsu is EdgeThreshold::noise.
  EdgeSegmentOptions edges;
  double stretch_low = 0.001;   ///< share of pixels shown black; dim 16-bit pictures are stretched to 0..255
  double stretch_high = 0.999;  ///< share of pixels below white
  double hot_pixel_sd = 8;  ///< a pixel this many noise sd off its 3x3 median is replaced by it; 0: keep all
  double flatten_px = 33;   ///< side of the square whose mean is taken off before edges are sought; 0: none
  int halvings = 4;         ///< edges are sought in the picture and in up to this many halved copies of it
  int trials = 20000;       ///< random triples of edge pixels per copy
  std::uint64_t seed = 1;   ///< of the random search
  double min_radius_share = 0.08;  ///< smallest radius looked for, as a share of the picture's smaller side
  double min_arc_deg = 10;         ///< shorter arcs are refused: their radius would be a guess
  double max_sd_share = 0.15;      ///< a radius with a larger sd / radius is refused
  double min_support = 0.65;       ///< share of the circle's arc in the picture that must show the edge
  double max_log10_false_alarms = -4.5;  ///< a circle that chance would give more often than this is refused
  double min_contrast_steps = 2;         ///< least contrast in grey steps where noise does not hide the steps
  DropSide side = DropSide::automatic;
  std::string name = "drop edge";  ///< `where` of errors: give the picture's file name
};

}  // namespace faba
