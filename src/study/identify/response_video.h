#pragma once
#include <filesystem>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "study/identify/episode.h"
#include "vision/cells/video_ground.h"
#include "vision/drop/drop_edge.h"

namespace faba {

/// What keeps the cells together.
enum class Boundary {
  drop,  ///< the edge of a drop, which is found in the first frame
  box,   ///< a rectangle, all of it in view
  none   ///< nothing that is near: cells that leave the view are gone
};

/// What is said of a video of an experiment.
struct ResponseInput {
  std::filesystem::path file;  ///< video or run directory
  std::string experiment;      ///< to which it belongs
  double exposure_s = 0;       ///< time of the sample in air before the video
  double fps = 0;              ///< > 0: in place of what the video states
  std::optional<double> um_per_px;
  std::optional<double> reversal_s;     ///< when the field is reversed; found when absent, as is the next:
  std::optional<double> direction_deg;  ///< in which cells swim from then on; found when absent
  std::optional<double> duration_s;     ///< from there on; to the video's end when absent
  std::vector<FieldSegment> segments;   ///< in place of these three; times in the video
};

/// What the video tells: all that is needed to simulate the same and to measure both alike.
struct ResponseVideo {
  ResponseInput input;
  std::filesystem::path file;  ///< the video itself
  int side = 1;  ///< of the squares that frames are averaged over, px of the video; px below are
                 ///< those of the averaged frames
  CellView view;
  double fps = 0, um_per_px = 0;
  std::optional<DropEdge> edge;               ///< with Boundary::drop
  std::shared_ptr<const VideoGround> ground;  ///< light and noise
  double cell_px = 0, contrast = 0;  ///< of a cell that is rendered: width as seen, and as in [microscope]
  std::optional<double> field_t;     ///< strength of the field, T, as a run recorded it
  bool segments_detected = false;    ///< in the video; else they were given, or a run recorded its field
  std::vector<Episode> episodes;
  std::vector<std::shared_ptr<const EpisodeStatistics>> statistics;  ///< of each episode
  std::vector<std::vector<double>> observed;                         ///< what they give for the video
  std::vector<std::vector<GrayF>> pictures;  ///< of each episode at its picture_times(), greys of 0 to 255
  std::vector<std::string> notes;
};

}  // namespace faba
