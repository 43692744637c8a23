#pragma once
#include "study/tracks/track_survey.h"
#include "vision/foreground/foreground.h"

namespace faba {

/// Position of the swarm in the region of the frames of a surveyed video, without detection of single cells:
/// for dense swarms (theory H5, with the background of the complete video).
class SwarmView {
 public:
  /// `bits`: see VideoReader.
  SwarmView(const TrackSurvey& survey, int bits);
  SwarmMoments take(const GrayF& frame, double t_s);

 private:
  Foreground foreground_;
  PixelRegion region_;
  float scale_ = 1;  ///< to grey levels 0 to 255
  double noise_ = 0, last_s_ = 0;
};

}  // namespace faba
