#pragma once
#include "core/vec.h"
#include "vision/drop/circle_fit.h"
#include "vision/image/image.h"

namespace faba {

/// Whether small spots (cells) are detected outside the circle and hardly any inside: at least 10 spots, 4
/// times the density, and a binomial probability below 1e-6. Pixels within `margin_px` of the edge are
/// excluded.
bool cells_only_outside(const GrayF& picture, const Circle& circle, double margin_px);

/// A point of the picture on the given side of the circle, away from the edge: inside, the centroid of the
/// visible part of the disk; outside, the picture point farthest from the circle. The circle must cross the
/// picture.
Vec2 point_on_side(int width, int height, const Circle& circle, bool inside);

}  // namespace faba
