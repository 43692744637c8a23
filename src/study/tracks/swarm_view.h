#pragma once
#include <filesystem>
#include <functional>
#include <optional>

#include "study/tracks/track_survey.h"
#include "vision/foreground/foreground.h"

namespace faba {

/// Where the swarm is in the frames of a video of which a first pass is done, without its cells being found
/// one by one: for crowds in which they cannot be (theory H5, with the background of the whole video).
class SwarmView {
 public:
  /// `bits` as VideoReader gives it.
  SwarmView(const TrackSurvey& survey, int bits);
  SwarmMoments take(const GrayF& frame, double t_s);

 private:
  Foreground foreground_;
  float scale_ = 1;  ///< to greys of 0 to 255
  double noise_ = 0, last_s_ = 0;
};

/// Frames from one time to another, s; at `fps` > 0 in place of what the video states.
struct VideoPart {
  double from_s = 0;
  std::optional<double> to_s = {};
  double fps = 0;
  bool holds(double t_s) const { return t_s >= from_s && (!to_s || t_s <= *to_s); }
};

/// Cells in view, as spots that Detector finds: the mean over fifty frames or more of a part of a video
/// (anything VideoReader reads, or a run). Of a run without a camera's video it is the number that is in its
/// series. Empty for a file of flows, which shows no cells. `keep_running` is asked between frames;
/// Error(interrupted) when it says no. Throws as VideoReader.
std::optional<double> visible_cells(const std::filesystem::path& path, const VideoPart& part,
                                    const std::function<bool()>& keep_running);

}  // namespace faba
