#pragma once
#include "core/vec.h"
#include "vision/drop/circle_fit.h"
#include "vision/image/image.h"

namespace faba {

/// Whether small spots (cells) are seen on the far side of a circle's edge and hardly any on the side of its
/// centre: at least 10 spots, 4 times as dense, and a split that chance gives to less than one picture in a
/// million. Pixels within `margin_px` of the edge are left out.
bool cells_only_outside(const GrayF& picture, const Circle& circle, double margin_px);

/// A point of the picture on the given side of the circle, well away from the edge: inside, the centroid of
/// the disk's visible part; outside, the picture point farthest from the circle. The circle must cross the
/// picture.
Vec2 point_on_side(int width, int height, const Circle& circle, bool inside);

}  // namespace faba
