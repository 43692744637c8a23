#pragma once
#include <vector>

#include "study/tracks/track_result.h"
#include "study/tracks/track_survey.h"

namespace faba {

/// Accumulates the spots of the frames of a video. Memory: the first 200 000 signal-to-noise ratios.
class SpotSums {
 public:
  void take(const std::vector<Spot>& spots);
  /// Fills spots_per_frame and the means over the spots.
  void describe(TrackDetection& detection) const;

 private:
  double frames_ = 0, spots_ = 0, elongation_ = 0, place_sd_ = 0;
  std::vector<double> snr_;
};

/// The spots of a frame, in coordinates of the frame, as the survey found that they should be searched.
/// `detector`: in the region of the survey.
std::vector<Spot> spots_in(const GrayF& frame, const Detector& detector, const TrackSurvey& survey);

/// Parameters of the detection, without its results.
TrackDetection detection_of(const TrackOptions& o, const TrackSurvey& s, const Detector& detector,
                            const std::optional<DropMask>& drop);

/// The drop of the first frame, when the search is restricted to it. Throws Error as find_drop_edge().
std::optional<DropMask> drop_of(const TrackOptions& o, const TrackSurvey& s);

}  // namespace faba
