#pragma once
#include <filesystem>
#include <optional>
#include <vector>

#include "study/data/provenance.h"
#include "study/data/video_part.h"
#include "study/data/video_scale.h"
#include "vision/cells/tracker.h"
#include "vision/foreground/background.h"
#include "vision/image/region.h"

namespace faba {

/// Method for the background of a video.
enum class BackgroundKind {
  automatic,  ///< median, unless more than half of the spots do not move and would vanish with it
  median,     ///< temporal median: removes everything that never moves, such as the edge of a drop
  spatial     ///< smoothing of each frame: keeps stationary objects
};

/// Format of a table of tracks.
enum class TrackFormat {
  automatic,  ///< csv or hdf5, by the extension of the file
  csv,        ///< `track,frame,t_s,x_px,y_px,mass,snr`
  hdf5,       ///< a dataset for each of these columns
  trackmate,  ///< CSV for the importer of TrackMate: `track,frame,t_s,x,y,z,quality`, in um if the scale is
              ///< known
  napari      ///< CSV for the tracks layer of napari: `track_id,frame,y,x`, in px
};
/// Words for the formats, in their order.
inline constexpr const char* kTrackFormatWords[] = {"automatic", "csv", "hdf5", "trackmate", "napari"};

/// A file for the tracks.
struct TrackTable {
  std::filesystem::path file;
  TrackFormat format = TrackFormat::automatic;
};

/// Options of `faba track`. Unspecified values are determined from the video.
struct TrackOptions {
  std::filesystem::path video;      ///< anything VideoReader reads, or a run directory
  VideoPart part;                   ///< frames outside of it are not used
  unsigned threads = 0;             ///< 0: all; they do not change the result
  VideoScale scale;                 ///< given by the user; overrides that of the run or file
  std::vector<TrackTable> out;      ///< tables of the tracks
  std::filesystem::path swarm;      ///< table of position and dispersion of the swarm in each frame, .csv
  std::filesystem::path overlay;    ///< video with the tracks, .mp4 or .avi
  std::filesystem::path report;     ///< page with the figures, .html
  std::filesystem::path picture;    ///< all tracks on the first frame, .png
  std::filesystem::path per_track;  ///< table with a row for each track, .csv
  std::filesystem::path figures;    ///< folder for the figures, one .svg each
  double size_px = 0;               ///< full width at half maximum of a spot; 0: automatic
  Polarity polarity = Polarity::automatic;
  BackgroundKind background = BackgroundKind::automatic;
  double threshold_sd = 0;  ///< smallest signal-to-noise ratio; 0: for 0.1 false detections per frame
  std::optional<PixelRegion> region;  ///< only this part of the frames is searched; empty: all of it
  bool inside_drop = false;  ///< detect the edge of the drop in the first frame and search inside it only
  TrackerOptions tracker;
  bool keep_drift = false;     ///< do not subtract the motion of the stage
  int interval_frames = 0;     ///< interval of displacements for speeds and turns; 0: automatic
  Provenance provenance = {};  ///< for the report
};

}  // namespace faba
