#pragma once
#include <functional>
#include <vector>

#include "study/identify/response_video.h"

namespace faba {

/// The frames of the video that are nearest to given moments, greys of 0 to 255. `tick` is called after each
/// frame that is read.
std::vector<GrayF> frames_at(const ResponseVideo& v, const std::vector<double>& times_s,
                             const std::function<void()>& tick);

/// Moments of an episode that pictures are shown of, s.
std::vector<double> picture_times(const Episode& episode);

/// Reads the video several times: for its background, the noise, the segments where they are not given, and
/// the frames that are measured. `tick` is called after every frame. Throws Error(input) for videos that
/// cannot be read, show no cells, no motion, or no edge with Boundary::drop.
ResponseVideo survey_response(const ResponseInput& input, Boundary boundary, Measure measure,
                              const std::function<void()>& tick);

}  // namespace faba
