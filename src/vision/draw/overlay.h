#pragma once
#include "vision/drop/drop_edge.h"
#include "vision/image/image.h"

namespace faba {

/// The picture in grey (stretched between its 0.1 % and 99.9 % percentiles) with the drop's edge drawn on it:
/// Hough segments thin violet, supporting edge points as yellow dots, the fitted circle blue, its centre as a
/// blue cross when it is in view, and an orange ring round a point inside the drop. Thin lines with a dark
/// rim, from the Okabe-Ito palette, which colour-blind readers can tell apart. Same size as the picture; an
/// empty picture gives an empty one.
RgbImage drop_overlay(const GrayF& picture, const DropEdge& edge);

/// The picture's edge pixels before any line is sought (theory A13, step 3): white on black.
Gray8 edge_pixel_picture(const GrayF& picture, const DropEdgeOptions& options = {});

/// The Hough segments along the drop's edge (theory A13, step 4), violet on a dimmed picture.
RgbImage hough_picture(const GrayF& picture, const DropEdge& edge);

}  // namespace faba
