#pragma once
#include <vector>

#include "study/quality/quality.h"

namespace faba {

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
