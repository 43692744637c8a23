#pragma once
#include <algorithm>
#include <cmath>
#include <opencv2/core/types.hpp>

#include "core/vec.h"

namespace faba {

/// Sub-pixel bits of OpenCV's drawing functions: coordinates in units of 1/16 px.
inline constexpr int kShift = 4;

/// A length in px, as a fixed-point number. Limited to ±30 000 px: OpenCV computes with 32-bit integers.
inline int fixed_length(double px) { return int(std::lround(std::clamp(px, -3e4, 3e4) * (1 << kShift))); }
/// A position in the picture, px, as fixed-point numbers.
inline cv::Point fixed_point(Vec2 p) { return {fixed_length(p.x), fixed_length(p.y)}; }

}  // namespace faba
