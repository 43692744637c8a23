#pragma once
#include <vector>

#include "study/quality/quality.h"

namespace faba {

/// Displacement between frames, over the mean distance of the objects, above which tracks often join wrong
/// ones.
inline constexpr double kFarStep = 0.3;
/// Fraction of the picture that spots cover, above which they overlap the rings of their local offsets.
inline constexpr double kCoveredPicture = 0.05;

struct TrackDetection;
struct TrackMeasurement;

/// The violated assumptions of the detection alone: noise, texture and size.
std::vector<Warning> detection_warnings(const TrackDetection& detection);
/// The violated assumptions of a tracking: noise removed by the coding of the video, a picture full of
/// detections (texture), objects of two sizes, a drift of the stage, links that are not reproduced,
/// displacements similar to the distance between objects, turns faster than the frame rate, and fits that do
/// not describe the mean-square displacement.
std::vector<Warning> track_warnings(const TrackMeasurement& tracks);

}  // namespace faba
