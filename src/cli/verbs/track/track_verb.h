#pragma once
#include <filesystem>
#include <string>
#include <vector>

#include "cli/command_line.h"
#include "cli/options/engine.h"
#include "cli/options/video_part.h"
#include "study/tracks/track_options.h"

namespace faba::cli {

/// The options of `faba track`.
struct TrackVerb {
  std::vector<std::filesystem::path> videos, out;
  std::filesystem::path swarm, overlay, report, picture, figures, per_track, preview;
  std::vector<std::string> formats;  ///< of `out`: none, one for all, or one for each
  std::filesystem::path folder;      ///< of the results of several videos
  std::filesystem::path result;      ///< folder of the result of one video
  std::filesystem::path edits;       ///< file with edits of such a result
  std::string scale;                 ///< number or calibration file
  std::vector<int> region;           ///< column, row, width, height
  std::string polarity = "auto", background = "auto", motion = "auto";
  double fps = 0, size_px = 0, threshold = 0, search_radius_px = 0;
  int max_gap_frames = 2, min_points = 3, interval = 0;
  PartOptions part;
  unsigned threads = 0;
  bool drop = false, keep_drift = false, force = false;
  EngineOptions engine;
};

/// Adds the options of the verb.
void add_track_options(CLI::App* v, TrackVerb& o);
/// Options for one of the videos.
TrackOptions options_of(const TrackVerb& v, const std::filesystem::path& video);
/// The tables of the tracks with their formats. Throws Error(usage) when their numbers differ.
std::vector<TrackTable> tables_of(const TrackVerb& v);
/// Extensions that a table may have.
std::vector<std::string> extensions_of(TrackFormat format);
/// Checks the names of the output files. `inputs`: they may not be replaced.
void check_outputs(const TrackVerb& v, bool force, const std::vector<std::filesystem::path>& inputs);
/// Applies a file of edits to the result of a tracking.
int apply_track_edits(const TrackVerb& v, const Common& c);
/// Tracks several videos, each into a folder of its own, in this process or by an engine.
int track_videos(const TrackVerb& v, const Common& c);

}  // namespace faba::cli
