#pragma once
#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "core/toml.h"
#include "study/tracks/track_edits.h"

namespace faba {

/// Names of the files in the folder of a tracked video (`faba track --result`).
namespace track_files {
inline constexpr const char* kTracks = "tracks.csv";
inline constexpr const char* kPerTrack = "per_track.csv";
inline constexpr const char* kReport = "tracks.html";
inline constexpr const char* kSummary = "track.json";  ///< output of --json; is written last
inline constexpr const char* kEdits = "edits.toml";    ///< cuts and changes by hand
}  // namespace track_files

/// The result of tracking a video, as read from its folder.
struct TrackFolder {
  Json summary;               ///< of the measured tracks
  std::vector<Track> tracks;  ///< measured, in the order of the file
  std::string sha256;         ///< of tracks.csv
  int width = 0, height = 0;  ///< of the frames, px; 0: not stated
  double frame_s = 1;
  bool timed = true;  ///< false: times are frame counts
  int interval = 1;   ///< frames of the displacements for speeds
  std::optional<double> um_per_px;
  bool drift_removed = false;
};

/// Whether a folder has the result of a tracked video.
bool holds_tracks(const std::filesystem::path& folder);
/// Reads tracks.csv and track.json. Throws Error(input) if one is missing or damaged.
TrackFolder read_track_folder(const std::filesystem::path& folder);

/// Reads the tables [[cut]] and [[edit]]. Throws Error(usage) with the key, also if `sha256` in the document
/// is not that of the tracks.
TrackEdits read_track_edits(const Document& d, const TrackFolder& tracks);
/// The edits of the file edits.toml; none if it does not exist.
TrackEdits read_track_edits(const std::filesystem::path& folder, const TrackFolder& tracks);
/// The document of edits, with the digest of the tracks for which they are made.
Json edits_document(const TrackEdits& edits, const TrackFolder& tracks);

/// A tracked video with its edits.
struct EditedFolder {
  std::vector<EditedTrack> tracks;
  TrackEdits edits;
};
EditedFolder apply_edits(const TrackFolder& folder, TrackEdits edits);

/// The detections of the used tracks, with the columns of tracks.csv below comments with the edits.
std::string edited_tracks_csv(const TrackFolder& folder, const EditedFolder& edited);
/// A row with the features of each used track, below the same comments.
std::string track_features_csv(const TrackFolder& folder, const EditedFolder& edited);
/// Output of `faba track --edits --json`: the output of the tracking, in which the motion is that of the used
/// tracks, and `edits` with the numbers of tracks.
Json edited_json(const TrackFolder& folder, const EditedFolder& edited);

}  // namespace faba
