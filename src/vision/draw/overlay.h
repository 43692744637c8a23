#pragma once
#include "vision/drop/drop_edge.h"
#include "vision/image/image.h"

namespace faba {

/// The picture (see read_displayed()) with the detected drop edge:
/// Hough segments in violet, supporting edge points as yellow dots, the fitted circle in blue, its centre as
/// a blue cross if visible, and an orange ring around a point inside the drop. Thin lines with a dark outline
/// in the colour-blind-safe Okabe-Ito palette. Same size as the picture; an empty picture gives an empty one.
RgbImage drop_overlay(const RgbImage& picture, const DropEdge& edge);

/// Edge pixels of the picture before the line search (theory A13, step 3): white on black.
Gray8 edge_pixel_picture(const GrayF& picture, const DropEdgeOptions& options = {});

/// Hough segments along the drop edge (theory A13, step 4), violet on a dimmed picture.
RgbImage hough_picture(const RgbImage& picture, const DropEdge& edge);

}  // namespace faba
