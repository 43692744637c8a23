#pragma once
#include <cstdint>
#include <functional>
#include <memory>
#include <mutex>
#include <optional>
#include <vector>

#include "study/data/run_video.h"
#include "study/tracks/indexed_frames.h"
#include "study/tracks/track_result.h"
#include "study/tracks/track_survey.h"

namespace faba {

/// The detection of spots in one frame.
struct ProbedFrame {
  std::int64_t index = 0;  ///< of the frame in the file, as in a table of tracks
  double t_s = 0;
  std::vector<Spot> spots;
  TrackDetection detection;  ///< its means are those of this frame
  std::vector<Warning> warnings;
};

/// Tracks over some consecutive frames.
struct ProbedLinks {
  std::int64_t first = 0;  ///< index of the first frame
  int frames = 0;          ///< fewer than requested at the end of the video
  std::vector<Track> tracks;
  double search_radius_px = 0;
  Motion motion = Motion::nearest;
  bool crowded = false;
};

/// Detects spots in single frames of a video with the result of tracking the complete video, for options that
/// change often: the frames from which background and noise are computed are read once (see sample_frames()).
/// Thread-safe.
class TrackProbe {
 public:
  /// Reads the sampled frames. `options`: its video, part, region and drop are those of all later calls.
  /// `progress` returns false to cancel with Error(Errc::interrupted). Throws as preview_tracks().
  TrackProbe(TrackOptions options, RunVideo source,
             const std::function<bool(std::int64_t done, std::int64_t total)>& progress);

  const IndexedFrames& frames() const { return frames_; }
  float black() const { return surveyed_.survey.black; }  ///< grey values for display
  float white() const { return surveyed_.survey.white; }
  const VideoScale& scale() const { return source_.scale; }

  /// Size, threshold, polarity, background and tracker are taken from `o`. Throws Error(Errc::input) if the
  /// video has no such frame.
  ProbedFrame detect(const TrackOptions& o, std::int64_t index);
  /// Tracks in at most `count` frames from the frame `first`.
  ProbedLinks link(const TrackOptions& o, std::int64_t first, int count);

 private:
  /// What follows from the options for spots.
  struct Prepared {
    TrackOptions options;
    TrackSurvey survey;
    TrackDetection detection;
    std::unique_ptr<const Detector> detector;
  };

  const Prepared& prepared(const TrackOptions& o);

  TrackOptions options_;
  RunVideo source_;
  std::mutex mutex_;
  IndexedFrames frames_;
  SurveyedFrames surveyed_;
  std::optional<Prepared> prepared_;
};

}  // namespace faba
