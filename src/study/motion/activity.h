#pragma once
#include <filesystem>
#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "study/motion/response.h"
#include "study/motion/segments.h"
#include "study/quality/quality.h"
#include "study/stats/exposure_lines.h"
#include "study/stats/gaussian_fit.h"

namespace faba {

/// One video of an activity study.
struct ActivityInput {
  std::filesystem::path file;                ///< video, run directory or file of flows
  std::optional<double> exposure_s = {};     ///< air exposure time of the sample before the video
  std::string experiment = {};               ///< name of the experiment; may be empty
  std::optional<double> direction_deg = {};  ///< of the expected response, image frame; detected when empty
  std::optional<double> reversal_s = {};     ///< time of the field reversal
  double from_s = 0;                         ///< start of the evaluation, and zero of time for exposure lines
  std::optional<double> to_s = {};           ///< end of the evaluation
  std::optional<VideoScale> scale = {};      ///< given by the user, instead of that of the file
};

/// Input of measure_activity() (theory A16).
struct ActivityJob {
  std::vector<ActivityInput> videos;
  std::optional<double> threshold_px;  ///< smaller flows are noise, px per pair; determined when empty
  std::filesystem::path noise;         ///< a video without motion (a dead sample), for the threshold
  FlowRegistry::PartType method;
  int shrink = 0;                 ///< see FlowSourceOptions
  double fps = 0;                 ///< see FlowSourceOptions
  std::string options_text = {};  ///< see FlowSourceOptions
  bool frames = false;            ///< see FlowSourceOptions
  bool cells = true;              ///< count the cells in view; reads the video again
  bool responses = true;          ///< measure the response to the field reversal; reads part of it again
  unsigned threads = 0;           ///< 0: all
  /// Called with the index of the video, and the number of its pairs of frames done and in total; the total
  /// is 0 when unknown.
  std::function<void(std::size_t video, std::uint64_t done, std::uint64_t total)> progress = [](auto, auto,
                                                                                                auto) {};
  std::function<bool()> stop = [] { return false; };
};

/// The activity of one video.
struct VideoActivity {
  ActivityInput input;
  VideoScale scale;
  Signature signature{0, 0};
  double threshold_px = 0;
  double direction_deg = 0;      ///< of the expected response
  bool direction_given = false;  ///< else it is that of the longest segment, or of the total flow
  std::vector<MotionSegment> segments;
  std::vector<double> t_s, amount,
      along;  ///< per pair: amount() and along() of the signature in that direction
  double mean_amount = 0, mean_along = 0;
  bool timed = true;                    ///< false: no frame rate is stated, and times are frame counts
  double frame_s = 0;                   ///< median time between the frames of a pair
  std::optional<double> visible_cells;  ///< mean number; empty for a file of flows
  GaussianFit fit;                      ///< of `amount`
  /// Points (2) and (3) of Fig. 4.9 of the thesis; only with a good fit.
  std::optional<double> maximum_s, departure_s;
  std::optional<Response> response;  ///< to the field reversal, with point (1)
  double view_px = 0;                ///< area of the frames, px^2
  std::optional<double> um_per_px;   ///< image scale; empty when it is unknown
  /// Mean flow along the direction over its standard error, estimated from the flow across. Only for a given
  /// direction: a detected one is biased towards the largest flow. Infinite when the flow across is exactly
  /// zero, as in computed flows.
  std::optional<double> signal_to_noise;
  /// Whether there is a response: that of Response when the time of the reversal is known, else a peak of
  /// activity, or a flow along the direction of at least four standard errors. The flow of cells that move
  /// further than their size between frames has no direction; their response is detected by the peak only.
  bool responds = false;
  FlowPair busiest;        ///< pair with the largest flow (along the direction if given), for pictures
  double busiest_deg = 0;  ///< direction of its flow
  std::vector<Warning> warnings;
  std::vector<std::string> notes;
};

/// Speed of the responding objects in um/s: its interval includes the standard error of the scale. Empty
/// without a response or a scale.
std::optional<Measured> speed_um_s(const VideoActivity& video);

/// Point (1) of Fig. 4.9 of the thesis, the onset of the response; empty without a response.
std::optional<ChangePoint> onset_of(const VideoActivity& video);
/// A good peak that at least doubles the activity: random clusters of cells give smaller peaks.
bool has_peak(const VideoActivity& video);
/// Mean activity over the number of cells in view, to compare drops with different numbers of cells. Empty
/// when that number is unknown or zero.
std::optional<double> activity_per_cell(const VideoActivity& video);

/// Results of one or several videos.
struct ActivityResult {
  std::vector<VideoActivity> videos;
  std::optional<ExposureLine> peak_line, peak_line_pooled;  ///< time of the maximum against exposure, s
  std::optional<ExposureLine> mean_line, mean_line_pooled;  ///< mean activity against exposure
  std::optional<ExposureLine> per_cell_line, per_cell_line_pooled;  ///< mean activity per visible cell
  std::optional<double> frame_s;  ///< frame period, when equal in all videos
  std::optional<Cutoff> cutoff;
};

/// The warnings of all videos; with several, the evidence names the video.
std::vector<Warning> all_warnings(const ActivityResult& result);

/// Measures the videos in sequence and fits the exposure lines. Without `noise` and `threshold_px` the
/// smallest threshold of all videos is used. Throws the errors of FlowSource, and Error(interrupted).
ActivityResult measure_activity(const ActivityJob& job);

// The stages of measure_activity(), for several processes.
/// The videos from which the common threshold is determined: `noise`, or all of several videos. Empty when
/// it is given, and for a single video, which is measured with its own threshold.
std::vector<ActivityInput> threshold_inputs(const ActivityJob& job);
/// The threshold of one of them, px per pair.
double threshold_of(const ActivityJob& job, const ActivityInput& video);
/// The common threshold from all of them.
std::optional<double> common_threshold(const ActivityJob& job, const std::vector<double>& thresholds);
/// Measures one video with the common threshold.
VideoActivity measure_video(const ActivityJob& job, std::size_t index, std::optional<double> threshold_px);
/// Fits the exposure lines.
ActivityResult activity_result(std::vector<VideoActivity> videos);

}  // namespace faba
