#pragma once
#include <filesystem>
#include <functional>
#include <optional>

#include "study/tracks/track_survey.h"
#include "vision/foreground/foreground.h"

namespace faba {

/// Position of the swarm in the frames of a surveyed video, without detection of single cells: for dense
/// swarms (theory H5, with the background of the complete video).
class SwarmView {
 public:
  /// `bits`: see VideoReader.
  SwarmView(const TrackSurvey& survey, int bits);
  SwarmMoments take(const GrayF& frame, double t_s);

 private:
  Foreground foreground_;
  float scale_ = 1;  ///< to grey levels 0 to 255
  double noise_ = 0, last_s_ = 0;
};

/// An interval of a video, s; `fps` > 0 overrides the frame rate of the video.
struct VideoPart {
  double from_s = 0;
  std::optional<double> to_s = {};
  double fps = 0;
  bool holds(double t_s) const { return t_s >= from_s && (!to_s || t_s <= *to_s); }
};

/// Number of cells in view, detected by Detector: the mean over at least fifty frames of an interval of a
/// video (anything VideoReader reads, or a run). For a run without a camera video it is read from its series.
/// Empty for a file of flows, which has no frames. `keep_running` is called between frames;
/// Error(interrupted) when it returns false. Throws the errors of VideoReader.
std::optional<double> visible_cells(const std::filesystem::path& path, const VideoPart& part,
                                    const std::function<bool()>& keep_running);

}  // namespace faba
