#pragma once
#include <filesystem>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "study/data/video_part.h"
#include "study/identify/statistics/episode.h"
#include "vision/cells/video_ground.h"
#include "vision/drop/drop_edge.h"

namespace faba {

/// Boundary that confines the cells.
enum class Boundary {
  drop,  ///< edge of a drop, detected in the background of the video
  box,   ///< rectangle equal to the view
  none   ///< no boundary near the view
};

/// Configuration of a video of an experiment.
struct ResponseInput {
  std::filesystem::path file;  ///< video or run directory
  std::string experiment;      ///< name of the experiment
  double exposure_s = 0;       ///< air exposure time before the video
  VideoPart part;              ///< that is used, and the frame rate if it is not that of the file
  unsigned threads = 0;        ///< that read the video; 0: all
  std::optional<double> um_per_px;
  std::optional<double> reversal_s;     ///< time of the field reversal; empty: detected
  std::optional<double> direction_deg;  ///< swimming direction after it; empty: detected
  std::optional<double> duration_s;     ///< duration after it; empty: to the end of the video
  std::vector<FieldSegment> segments;   ///< instead of these three; times in the video
  std::string where;                    ///< place in the study file, for messages; may be empty
  std::string digest = {};              ///< of the content of the video, see digest_videos()
};

/// Result of the measurement of a video: everything to simulate it and to measure the simulations equally.
struct ResponseVideo {
  ResponseInput input;
  std::filesystem::path file;  ///< the video itself
  int side = 1;  ///< frames are averaged over squares of this side, px of the video; all px below are those
                 ///< of the averaged frames
  CellView view;
  double fps = 0, um_per_px = 0;
  std::optional<DropEdge> edge;                   ///< with Boundary::drop
  std::shared_ptr<const VideoBackground> ground;  ///< background and noise
  std::size_t stationary = 0;        ///< stationary spots removed from the background, of the width of a cell
  double cell_px = 0, contrast = 0;  ///< of a rendered cell: width (FWHM), and contrast as in [microscope]
  std::optional<double> field_t;     ///< recorded field strength, T
  std::optional<double> recorded_um_per_px = {};  ///< recorded scale, if it differs from the one of the study
  bool segments_detected = false;                 ///< detected in the video, neither given nor recorded
  std::vector<Episode> episodes;
  std::vector<std::shared_ptr<const EpisodeStatistics>> statistics;  ///< of each episode
  std::vector<std::vector<double>> observed;                         ///< statistics of the video
  std::vector<std::vector<GrayF>> pictures;  ///< of each episode at picture_times(), grey values 0 to 255
  std::vector<std::string> notes;
};

}  // namespace faba
