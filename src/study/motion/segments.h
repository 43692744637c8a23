#pragma once
#include <cmath>
#include <optional>
#include <vector>

#include "study/motion/signature.h"

namespace faba {

/// A time during which what is seen moves in one direction.
struct MotionSegment {
  double t0_s = 0, t1_s = 0;
  double direction_deg = 0;  ///< image frame: 0 right, 90 down; 0 to 360
};

/// A direction as one says it: whole degrees, 0 to 359.
inline int whole_degrees(double deg) { return int(std::lround(deg) % 360 + 360) % 360; }

/// Cuts a video into segments of directed motion. Over windows of 0.4 s (three pairs at least) half of all
/// flow or more must go one way, and be a seventh or more of the most that the video has; a segment lasts
/// half a second or more, its pairs agree in direction beyond chance (Rayleigh, 1 in 1000), and it begins and
/// ends where the flow along it crosses half of its median. Turns of more than 60 degrees begin a new one.
/// With `direction_deg` only motion along it and against it counts.
std::vector<MotionSegment> motion_segments(const Signature& signature,
                                           std::optional<double> direction_deg = {});

}  // namespace faba
