#pragma once
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "study/tracks/populations.h"
#include "study/tracks/stage_drift.h"
#include "study/tracks/track_features.h"
#include "study/tracks/track_statistics.h"

namespace faba {

/// Keeps the tracks whose feature is between two limits, both included. A track without a value of the
/// feature does not pass.
struct TrackCut {
  TrackFeature feature = TrackFeature::speed;
  std::optional<double> min, max;
  bool passes(const TrackFeatures& f) const;
};

enum class TrackEditKind : std::size_t {
  remove,  ///< the track is wrong
  keep,    ///< the track is used whatever the cuts are
  split,   ///< its detections from a frame on become a new track, with the next free number
  join     ///< the detections of another track are added to it
};

/// One change by hand.
struct TrackEdit {
  TrackEditKind kind = TrackEditKind::remove;
  std::uint64_t track = 0;
  std::uint64_t frame = 0;  ///< split: first frame of the new track
  std::uint64_t with = 0;   ///< join: the track that is added
};

/// Changes of the result of a tracking. The measured tracks are not changed.
struct TrackEdits {
  std::vector<TrackCut> cuts;
  std::vector<TrackEdit> edits;  ///< in the order in which they are applied
};

/// What happens to a track.
enum class TrackFate {
  passes,   ///< the cuts
  cut,      ///< by at least one of them
  removed,  ///< by hand
  kept      ///< by hand
};

struct EditedTrack {
  Track track;
  TrackFeatures features{};
  TrackFate fate = TrackFate::passes;
  bool used() const { return fate == TrackFate::passes || fate == TrackFate::kept; }
};

/// Applies the edits in their order, then the cuts. Sorted by number. `frame_s`, `interval`: see
/// features_of(). Throws Error(Errc::usage, "edit[2]") for a track that does not exist at this point, a split
/// that leaves no detection on one side, and a join of tracks that overlap in time.
std::vector<EditedTrack> edited_tracks(std::vector<Track> measured, const TrackEdits& edits, double frame_s,
                                       int interval);

/// Motion of selected tracks.
struct SelectedMotion {
  TrackSummary summary;
  std::vector<SpeedPopulation> populations;
};

/// The statistics of `faba track` for the used tracks alone. The motion of the stage is that of all measured
/// tracks; it is subtracted if `subtract_drift` is set.
SelectedMotion motion_of(const std::vector<EditedTrack>& tracks, const std::vector<Track>& measured,
                         double frame_s, int interval, bool subtract_drift);

}  // namespace faba
