#include "study/tracks/track_edits.h"

#include <fmt/format.h>

#include <algorithm>
#include <map>

#include "core/error.h"
#include "core/threads/parallel.h"

namespace faba {
namespace {

// The tracks while the edits are applied.
class TrackEditing {
 public:
  explicit TrackEditing(std::vector<Track> measured) {
    for (Track& t : measured) {
      next_ = std::max(next_, t.number + 1);
      tracks_[t.number].track = std::move(t);
    }
  }

  void apply(const TrackEdit& e, std::size_t index) {
    place_ = fmt::format("edit[{}]", index);
    EditedTrack& t = find(e.track);
    switch (e.kind) {
      case TrackEditKind::remove:
        t.fate = TrackFate::removed;
        return;
      case TrackEditKind::keep:
        t.fate = TrackFate::kept;
        return;
      case TrackEditKind::split:
        return split(t.track, e.frame);
      case TrackEditKind::join:
        return join(t.track, e.with);
    }
  }

  std::vector<EditedTrack> tracks() {
    std::vector<EditedTrack> all;
    all.reserve(tracks_.size());
    for (auto& [_, t] : tracks_) all.push_back(std::move(t));
    return all;
  }

 private:
  EditedTrack& find(std::uint64_t number) {
    const auto it = tracks_.find(number);
    if (it == tracks_.end())
      throw Error(
          Errc::usage, place_,
          fmt::format("track {} does not exist; use the number of a measured track, or of one that an "
                      "earlier split created",
                      number));
    return it->second;
  }
  void split(Track& t, std::uint64_t frame) {
    const auto from =
        std::find_if(t.points.begin(), t.points.end(), [&](const TrackPoint& p) { return p.frame >= frame; });
    if (from == t.points.begin() || from == t.points.end())
      throw Error(Errc::usage, place_,
                  fmt::format("track {} cannot be split at frame {}; the frame must be between {} and {}",
                              t.number, frame, t.points.front().frame + 1, t.points.back().frame));
    Track rest;
    rest.number = next_++;
    rest.points.assign(from, t.points.end());
    t.points.erase(from, t.points.end());
    tracks_[rest.number].track = std::move(rest);
  }
  void join(Track& t, std::uint64_t with) {
    const Track& other = find(with).track;
    const bool before = t.points.back().frame < other.points.front().frame,
               after = other.points.back().frame < t.points.front().frame;
    if (!before && !after)
      throw Error(
          Errc::usage, place_,
          fmt::format("tracks {} and {} are in view at the same time; a track can be joined with one that "
                      "begins after its end or ends before its begin",
                      t.number, with));
    t.points.insert(before ? t.points.end() : t.points.begin(), other.points.begin(), other.points.end());
    tracks_.erase(with);
  }

  std::map<std::uint64_t, EditedTrack> tracks_;
  std::uint64_t next_ = 1;
  std::string place_;
};

}  // namespace

bool TrackCut::passes(const TrackFeatures& f) const {
  const double value = f[std::size_t(feature)];
  // A comparison with NaN is false.
  return (min ? value >= *min : value == value) && (max ? value <= *max : value == value);
}

std::vector<EditedTrack> edited_tracks(std::vector<Track> measured, const TrackEdits& edits, double frame_s,
                                       int interval) {
  TrackEditing editing(std::move(measured));
  for (std::size_t i = 0; i < edits.edits.size(); ++i) editing.apply(edits.edits[i], i);
  std::vector<EditedTrack> all = editing.tracks();
  for (EditedTrack& t : all) {
    t.features = features_of(t.track, frame_s, interval);
    if (t.fate != TrackFate::passes) continue;
    const bool passes = std::all_of(edits.cuts.begin(), edits.cuts.end(),
                                    [&](const TrackCut& c) { return c.passes(t.features); });
    if (!passes) t.fate = TrackFate::cut;
  }
  return all;
}

SelectedMotion motion_of(const std::vector<EditedTrack>& tracks, const std::vector<Track>& measured,
                         double frame_s, int interval, bool subtract_drift) {
  StageDrift stage;
  if (subtract_drift) {
    DriftSurvey survey(frame_s);
    for (const Track& t : measured) survey.take(t);
    stage = survey.result();
  }
  TrackStatistics statistics(frame_s, interval);
  PopulationSurvey populations(frame_s);
  for (const EditedTrack& t : tracks) {
    if (!t.used()) continue;
    const Track relative = stage.relative(t.track);
    statistics.take(relative);
    populations.take(relative);
  }
  SelectedMotion m;
  m.summary = statistics.summary();
  Pool pool(0);
  m.populations = populations.populations(m.summary.interval_frames,
                                          std::max(m.summary.localisation_px, stage.error_px), pool);
  return m;
}

}  // namespace faba
