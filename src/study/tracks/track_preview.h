#pragma once
#include <functional>
#include <vector>

#include "study/data/run_video.h"
#include "study/tracks/spot_sums.h"
#include "study/tracks/track_result.h"
#include "study/tracks/track_survey.h"
#include "vision/files/video_reader.h"

namespace faba {

/// A frame with the spots that would be tracked.
struct PreviewFrame {
  double t_s = 0;
  GrayF picture;
  std::vector<Spot> spots;
};

/// The detection of spots in some frames of a video, before all of them are tracked.
struct TrackPreview {
  TrackSurvey survey;  ///< of the frames from which the background of the video is computed
  TrackDetection detection;
  std::vector<PreviewFrame> frames;  ///< nine of them, or all if there are fewer
  std::vector<Warning> warnings;     ///< of the detection
  std::vector<std::string> notes;
};

/// Passes the frames from which the background is computed (see BackgroundSampler) to the surveyor, and then
/// to `take` with their time, the number done and the total. The frames between them are skipped, where the
/// format permits it without being decoded. If the file does not state its length, the first 40 frames are
/// used. Throws Error(Errc::input) when there are none.
void sample_frames(
    VideoReader& reader, const TrackOptions& o, const std::filesystem::path& name, TrackSurveyor& surveyor,
    const std::function<void(double t_s, const GrayF& frame, std::int64_t done, std::int64_t total)>& take);

/// Reads the frames from which the background is computed (see BackgroundSampler) in the part of the video
/// that the options name: the frames between them are skipped, where the format permits it without being
/// decoded. Background, polarity and size are those of the tracking of all frames. If the file does not state
/// its length, the first 40 frames are used. `tick` is called after each frame. Throws as survey_tracks().
TrackPreview preview_tracks(const TrackOptions& o, const RunVideo& source,
                            const std::function<void(std::int64_t done, std::int64_t total)>& tick);

}  // namespace faba
