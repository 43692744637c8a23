#pragma once
#include <filesystem>
#include <memory>
#include <string>
#include <vector>

#include "study/tracks/track_scores.h"
#include "vision/cells/tracker.h"

namespace faba {

/// Writes a table of tracks. The file has a temporary name until complete() is called, and is deleted
/// otherwise. CSV: `track,frame,t_s,x_px,y_px,mass,snr`. HDF5: one dataset for each of these columns, and
/// attributes `format` = "faba tracked 1", `um_per_px` (when known), `width_px`, `height_px`. Rows of one
/// part of a track are contiguous.
class TrackOutput {
 public:
  virtual ~TrackOutput() = default;
  virtual void write(const Track& track) = 0;
  virtual void complete() = 0;
};

/// Properties of the video for the attributes of an HDF5 file. um_per_px 0: unknown.
struct TrackedVideo {
  int width = 0, height = 0;
  double um_per_px = 0;
};

/// Creates the output for the extension of `path`: .csv or .h5. Throws Error(Errc::usage) for other
/// extensions, Error(Errc::internal) when the file cannot be written.
std::unique_ptr<TrackOutput> track_output(const std::filesystem::path& path, const TrackedVideo& video);

/// The first line of the CSV table, and the lines of a track.
inline constexpr const char* kTrackColumns = "track,frame,t_s,x_px,y_px,mass,snr\n";
std::string track_rows(const Track& track);

/// Table with a row for each track; lengths in px.
std::string per_track_csv(const std::vector<TrackScore>& scores);

}  // namespace faba
