#pragma once
#include <filesystem>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include <nlohmann/json_fwd.hpp>

#include "study/tracks/track_options.h"
#include "study/tracks/track_scores.h"
#include "vision/cells/tracker.h"

namespace faba {

/// Writes a table of tracks (see TrackFormat). The file has a temporary name until complete() is called, and
/// is deleted otherwise. HDF5: the rows have the dimension `point`; attributes `format` = "faba tracked 1",
/// `um_per_px` (when known), `width_px`, `height_px`. Rows of one part of a track are contiguous.
class TrackOutput {
 public:
  virtual ~TrackOutput() = default;
  virtual void write(const Track& track) = 0;
  virtual void complete() = 0;
};

/// Properties of the video of the tracks.
struct TrackedVideo {
  int width = 0, height = 0;        ///< px
  std::optional<double> um_per_px;  ///< empty: not known
  bool timed = true;                ///< false: times are frame counts
};

/// Creates the output. Throws Error(Errc::usage) for TrackFormat::automatic with an extension other than .csv
/// and .h5, Error(Errc::internal) when the file cannot be written.
std::unique_ptr<TrackOutput> track_output(const TrackTable& table, const TrackedVideo& video);

/// The tables in the output of `faba track --json`: `file`, `format`, `length_unit`, and for napari `scale`,
/// the argument of its function add_tracks.
nlohmann::ordered_json tables_json(const std::vector<TrackTable>& tables,
                                   const std::optional<double>& um_per_px);
/// The same for people, after the name of the file; empty for the formats of this program.
std::string table_remark(const TrackTable& table, const std::optional<double>& um_per_px);

/// The first line of the CSV table, and the lines of a track.
inline constexpr const char* kTrackColumns = "track,frame,t_s,x_px,y_px,mass,snr\n";
std::string track_rows(const Track& track);

/// Table with a row for each track; lengths in px.
std::string per_track_csv(const std::vector<TrackScore>& scores);

}  // namespace faba
