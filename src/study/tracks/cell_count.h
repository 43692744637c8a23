#pragma once
#include <cstdint>
#include <deque>
#include <filesystem>
#include <functional>
#include <memory>
#include <optional>

#include "study/data/frame_inspector.h"
#include "study/tracks/track_survey.h"
#include "vision/cells/detector.h"

namespace faba {

/// Counts the cells in view of a part of a video (anything VideoReader reads, or a run), detected by
/// Detector: the mean over 13 to 25 of its frames, or all if there are fewer. Needs two readings of the
/// frames, which may serve other work at the same time. For a run without a camera video the mean follows
/// from its series, and a file of flows has no frames: nothing is read then.
class CellCount {
 public:
  CellCount(const std::filesystem::path& path, const VideoPart& part, unsigned threads);

  /// Whether the two readings are needed.
  bool reads_frames() const { return !video_.empty(); }
  /// For the first reading, which end_survey() ends.
  FrameInspector survey();
  bool surveys_frames() const { return surveyor_ && surveyor_->frames() > 0; }
  void end_survey();
  /// For the second reading.
  FrameInspector count();
  /// Does a reading without other work. `check` is called between frames.
  void read(const FrameInspector& inspector, const std::function<void()>& check) const;

  /// The result; empty for a file of flows, and when there were no frames.
  std::optional<double> mean() const;

 private:
  std::size_t spots_in(GrayF& frame) const;  ///< replaces values that are not finite

  std::filesystem::path video_;
  VideoPart part_;
  unsigned threads_;
  TrackOptions options_;
  std::unique_ptr<TrackSurveyor> surveyor_;
  TrackSurvey survey_;
  std::unique_ptr<Detector> detector_;  ///< for a temporal background
  std::int64_t step_ = 1, frames_ = 0;
  std::deque<std::size_t> counts_;  ///< written by several threads, each one element
  std::optional<double> of_run_;
};

}  // namespace faba
