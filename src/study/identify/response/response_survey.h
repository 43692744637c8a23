#pragma once
#include <functional>
#include <vector>

#include "study/identify/response_video.h"

namespace faba {

/// Frames of the video nearest to the given times, grey values 0 to 255. `tick` is called after each frame
/// that is read.
std::vector<GrayF> frames_at(const ResponseVideo& v, const std::vector<double>& times_s,
                             const std::function<void()>& tick);

/// Times of the pictures of an episode in the report, s, relative to its start.
std::vector<double> picture_times(const Episode& episode);

/// Measures a video: background, noise, field segments if they are not given, and the statistics of its
/// episodes. Reads the video several times; `tick` is called after every frame. Throws Error(input) for
/// videos that cannot be read, without cells, without motion, or without a drop edge with Boundary::drop.
ResponseVideo survey_response(const ResponseInput& input, Boundary boundary, Measure measure,
                              const std::function<void()>& tick);

}  // namespace faba
