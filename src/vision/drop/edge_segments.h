#pragma once
#include <cstddef>
#include <vector>

#include "core/vec.h"
#include "vision/image/image.h"

namespace faba {

/// Rule for the gradient threshold of an edge.
enum class EdgeThreshold {
  legacy,  ///< sqrt(6 * mean of the squared gradient), the rule of the published program
  otsu,    ///< Otsu: maximum variance between the two classes of the gradient histogram
  noise,   ///< sqrt(4 * median of the squared gradient / ln 2): as legacy, but robust against strong edges
  fixed    ///< EdgeSegmentOptions::fixed_threshold
};

/// Parameters of steps 2 to 4 of the published procedure (theory A13). Lengths in px of the input picture.
struct EdgeSegmentOptions {
  double sigma_px = 1;  ///< sd of the Gaussian smoothing; 1: 5x5 kernel; 0: none
  EdgeThreshold threshold = EdgeThreshold::legacy;
  double fixed_threshold = 0;  ///< grey levels per px, used with EdgeThreshold::fixed only
  double min_length_px = 40;   ///< minimum length of a segment
  double fill_gap_px = 20;     ///< maximum gap that is bridged
  int max_segments = 60;       ///< maximum number; the longest are kept
  std::size_t max_edge_pixels =
      20000;  ///< maximum number; the strongest are kept, which limits the computing time
};

/// An edge pixel.
struct EdgePixel {
  Vec2 pos;     ///< picture position, px; includes the 0.5 px offset of the Roberts operator
  Vec2 normal;  ///< unit vector across the edge, from dark to bright
};

/// A straight edge segment, end points in picture px.
struct EdgeSegment {
  Vec2 a, b;
};

struct EdgeSegments {
  std::vector<EdgeSegment> segments;  ///< longest first
  std::vector<EdgePixel> support;     ///< edge pixels along one of the segments, row by row
  std::vector<EdgePixel> pixels;      ///< all edge pixels, row by row
  double threshold = 0;               ///< gradient threshold, grey levels per px
};

/// Gaussian smoothing (replicated border), Roberts cross, threshold and thinning, probabilistic Hough
/// transform, and the edge pixels that support the segments: within 1.5 px, gradient within 35 deg of the
/// segment normal. Bit-identical for the same picture and options. An empty or flat picture has no segments.
EdgeSegments find_edge_segments(const GrayF& picture, const EdgeSegmentOptions& options = {});

}  // namespace faba
