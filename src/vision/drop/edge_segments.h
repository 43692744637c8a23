#pragma once
#include <cstddef>
#include <vector>

#include "core/vec.h"
#include "vision/image/image.h"

namespace faba {

/// How strong a gradient must be to count as an edge.
enum class EdgeThreshold {
  legacy,  ///< sqrt(6 * mean of the squared gradient), the automatic rule of the published program
  otsu,    ///< the split of the gradient histogram with the largest variance between its two classes
  noise,   ///< 4 * median of the squared gradient / ln 2: the legacy kind of rule, not raised by strong edges
  fixed    ///< EdgeSegmentOptions::fixed_threshold
};

/// Parameters of steps 2 to 4 of the published procedure (theory A13). Lengths in px of the picture
/// given.
struct EdgeSegmentOptions {
  double sigma_px = 1;  ///< sd of the Gaussian smoothing; 1 gives the classic 5x5 kernel; 0 for none
  EdgeThreshold threshold = EdgeThreshold::legacy;
  double fixed_threshold = 0;           ///< grey levels per px, used with EdgeThreshold::fixed only
  double min_length_px = 40;            ///< shorter segments are dropped
  double fill_gap_px = 20;              ///< gaps up to this long are bridged
  int max_segments = 60;                ///< the longest are kept
  std::size_t max_edge_pixels = 20000;  ///< the strongest are kept: bounds the time spent on a busy picture
};

/// A pixel on an edge.
struct EdgePixel {
  Vec2 pos;  ///< picture position, px; Roberts' operator is centred between four pixels: + 0.5 px is included
  Vec2 normal;  ///< unit vector across the edge, from dark to bright
};

/// A straight piece of edge, both ends in picture px.
struct EdgeSegment {
  Vec2 a, b;
};

struct EdgeSegments {
  std::vector<EdgeSegment> segments;  ///< longest first
  std::vector<EdgePixel> support;     ///< every edge pixel that lies along one of the segments, row by row
  std::vector<EdgePixel> pixels;      ///< every edge pixel, row by row
  double threshold = 0;               ///< gradient above which a pixel was an edge, grey levels per px
};

/// Gaussian smoothing (replicated border), Roberts' cross, threshold and thinning, Hough lines cut into
/// segments, and the edge pixels that support the segments: within 1.5 px of one, with their gradient across
/// it to 35 deg. Same picture and options: same result, bit for bit. An empty or flat picture has no
/// segments.
EdgeSegments find_edge_segments(const GrayF& picture, const EdgeSegmentOptions& options = {});

}  // namespace faba
