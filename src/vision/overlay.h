#pragma once
#include "vision/drop_edge.h"

namespace faba {

/// The picture, stretched to 8 bits, with the supporting edge points, the fitted circle, its centre and a
/// point inside.
RgbImage drop_overlay(const GrayF& picture, const DropEdge& edge);

}  // namespace faba
