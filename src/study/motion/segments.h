#pragma once
#include <cmath>
#include <optional>
#include <vector>

#include "core/units.h"
#include "study/motion/signature.h"

namespace faba {

/// An interval of motion in one direction.
struct MotionSegment {
  double t0_s = 0, t1_s = 0;
  double direction_deg = 0;  ///< image frame: 0 right, 90 down; 0 to 360
};

/// A direction for display, rounded to integer degrees, 0 to 359.
inline int rounded_degrees(double deg) { return int(std::lround(deg) % 360 + 360) % 360; }

/// Direction of a vector of the image frame, 0 to 360 degrees.
inline double direction_of(Vec2 v) { return std::fmod(std::atan2(v.y, v.x) / kDegree + 360, 360); }

/// Splits a video into segments of directed motion. In windows of 0.4 s (at least three pairs) at least half
/// of the flow must be in one direction and be at least a seventh of the maximum in the video. A segment
/// lasts at least 0.5 s, the directions of its pairs agree significantly (Rayleigh test, p < 0.001), and it
/// starts and ends where the flow along it crosses half of its median. A change of direction by more than 60
/// degrees starts a new segment. With `direction_deg` only motion along that direction and against it is
/// used.
std::vector<MotionSegment> motion_segments(const Signature& signature,
                                           std::optional<double> direction_deg = {});

}  // namespace faba
