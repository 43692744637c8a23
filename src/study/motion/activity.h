#pragma once
#include <filesystem>
#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "study/motion/segments.h"
#include "study/stats/exposure_lines.h"
#include "study/stats/gaussian_fit.h"

namespace faba {

/// One video of an activity study.
struct ActivityInput {
  std::filesystem::path file;                ///< video, run directory or file of flows
  std::optional<double> exposure_s = {};     ///< time of the sample in air before the video
  std::string experiment = {};               ///< to which it belongs; may be empty
  std::optional<double> direction_deg = {};  ///< of the response expected, image frame; found when empty
  double from_s = 0;                ///< what comes before is left out; exposure lines count time from here
  std::optional<double> to_s = {};  ///< what comes after is left out
};

/// What `faba activity` is asked for (theory A16).
struct ActivityJob {
  std::vector<ActivityInput> videos;
  std::optional<double> threshold_px;  ///< flows of less are noise, px per pair; found when empty
  std::filesystem::path noise;         ///< a video without motion (a dead sample) to find it from
  FlowRegistry::PartType method;
  int shrink = 0;                 ///< see FlowSourceOptions
  double fps = 0;                 ///< see FlowSourceOptions
  std::string options_text = {};  ///< see FlowSourceOptions
  bool frames = false;            ///< see FlowSourceOptions
  bool cells = true;              ///< count the cells in view; costs another look at the video
  unsigned threads = 0;           ///< 0: all
  /// Called with the number of the video, and pairs of frames done and to do in it; to do is 0 when not
  /// known.
  std::function<void(std::size_t video, std::uint64_t done, std::uint64_t total)> progress = [](auto, auto,
                                                                                                auto) {};
  std::function<bool()> stop = [] { return false; };
};

/// The activity of one video.
struct VideoActivity {
  ActivityInput input;
  Signature signature{0, 0};
  double threshold_px = 0;
  double direction_deg = 0;      ///< of the expected response
  bool direction_given = false;  ///< else that of the segments, or of all flow together where there are none
  std::vector<MotionSegment> segments;
  std::vector<double> t_s, amount,
      along;  ///< per pair: amount() and along() of the signature in that direction
  double mean_amount = 0, mean_along = 0;
  double frame_s = 0;                   ///< median time between the frames of a pair
  std::optional<double> visible_cells;  ///< in the mean; empty for a file of flows
  GaussianFit fit;                      ///< of `amount`
  std::optional<double> onset_s, maximum_s,
      leaving_s;  ///< points (1), (2), (3) of the thesis's Fig. 4.9; with a good fit
  /// Mean flow along the direction over the error that the flow across it has; only of a direction that was
  /// given: one found in the video is that of its largest flow, whatever made it. Infinite when the flow
  /// across is exactly zero, as in a computed file of flows, so that it gives no error.
  std::optional<double> signal_to_noise;
  /// Whether there is a response: a peak of activity, or flow along the direction, of four standard errors or
  /// more. Where cells jump further than their own size from frame to frame their flow has no direction, and
  /// only the peak shows it.
  bool responds = false;
  FlowPair busiest;  ///< the pair with the most flow one way (along the direction, where it was given), for
                     ///< pictures
  double busiest_deg = 0;  ///< where its flow points
  std::vector<std::string> notes;
};

/// A good peak that at least doubles what there is: cells that respond to nothing crowd together by chance,
/// too.
bool has_peak(const VideoActivity& video);
/// Mean activity over the number of cells in view; drops differ in how many they hold. Empty where that is
/// not known, or none is seen.
std::optional<double> activity_per_cell(const VideoActivity& video);

/// Everything about one or several videos.
struct ActivityResult {
  std::vector<VideoActivity> videos;
  std::optional<ExposureLine> peak_line, peak_line_pooled;  ///< time of the maximum against exposure, s
  std::optional<ExposureLine> mean_line, mean_line_pooled;  ///< mean activity against exposure
  std::optional<ExposureLine> per_cell_line, per_cell_line_pooled;  ///< mean activity per visible cell
  std::optional<double> frame_s;                                    ///< of all videos, when it is the same
  std::optional<Cutoff> cutoff;
};

/// Measures the videos one after the other, then what they say together. Without `noise` and `threshold_px`
/// several videos share the smallest of their own thresholds. Throws what FlowSource throws, and
/// Error(interrupted).
ActivityResult measure_activity(const ActivityJob& job);

}  // namespace faba
