#include "study/tracks/track_measurement.h"

#include <algorithm>
#include <cmath>
#include <functional>
#include <iterator>
#include <optional>

#include <fmt/format.h>

#include "core/counted.h"
#include "core/threads/ordered_work.h"
#include "core/threads/parallel.h"
#include "study/tracks/link_check.h"
#include "study/tracks/spot_sums.h"
#include "study/tracks/track_warnings.h"
#include "vision/files/video_reader.h"

namespace faba {
namespace {

// The second pass over the frames: detection and tracking.
class TrackPass {
 public:
  TrackPass(const TrackOptions& o, const TrackSurvey& s, TrackListener& listener)
      : options_(o),
        survey_(s),
        listener_(listener),
        tracker_(o.tracker),
        links_(o.tracker),
        statistics_(s.frame_s, o.interval_frames),
        populations_(s.frame_s),
        drift_(s.frame_s),
        drop_(drop_of(o, s)) {}

  void run(const std::filesystem::path& video, const std::function<void(std::int64_t)>& tick) {
    const unsigned threads = OrderedWork::threads(options_.threads);
    VideoReader reader(video, options_.part.fps, threads);
    const Detector detector(survey_.background, detector_options(options_, survey_, drop_));
    detection_ = detection_of(options_, survey_, detector, drop_);
    std::uint64_t index = options_.part.from_s > 0 ? std::uint64_t(reader.skip_to(options_.part.from_s)) : 0;
    std::vector<SpottedFrame> frames(OrderedWork::slots(threads));
    const auto read = [&](std::size_t slot) {
      SpottedFrame& f = frames[slot];
      while (reader.next(f.t_s) && !options_.part.ends_before(f.t_s)) {
        f.index = index++;
        if (!options_.part.holds(f.t_s)) continue;
        reader.picture(f.picture);
        return true;
      }
      return false;
    };
    OrderedWork work(threads,
                     {read, [&](std::size_t slot, unsigned) { find_spots(detector, frames[slot]); }});
    for (std::int64_t done = 1; const std::optional<std::size_t> slot = work.next(); ++done) {
      take(frames[*slot]);
      tick(done);
    }
    tracker_.finish();
    Pool all_threads(threads);
    emit_tracks(all_threads);
    remove_drift();
  }

  TrackDetection detection() const {
    TrackDetection d = detection_;
    spots_.describe(d);
    return d;
  }
  TrackJoining joining() {
    return {tracker_.search_radius_px(), tracker_.motion(),           options_.tracker.max_gap_frames,
            options_.tracker.min_points, tracker_.discarded_tracks(), tracker_.crowded(),
            links_.reproduced()};
  }
  /// To be called after joining().
  std::vector<TrackScore> scores() const { return scores_.scores(links_); }
  const StageDrift& stage() const { return stage_; }
  std::vector<SpeedPopulation> populations(const TrackSummary& s) const {
    Pool pool(options_.threads);
    return populations_.populations(s.interval_frames, std::max(s.localisation_px, stage_.error_px), pool);
  }
  TrackSummary summary() { return statistics_.summary(); }
  std::int64_t repeated_times() const { return repeated_times_; }

 private:
  struct SpottedFrame {
    std::uint64_t index = 0;
    double t_s = 0;
    GrayF picture;
    std::vector<Spot> spots;
  };

  void find_spots(const Detector& detector, SpottedFrame& f) const {
    make_finite(f.picture);
    f.spots = spots_in(f.picture, detector, survey_);
  }
  void take(const SpottedFrame& f) {
    spots_.take(f.spots);
    if (f.t_s > last_s_) {
      tracker_.take(f.index, f.t_s, f.spots);
      links_.take(f.index, f.t_s, f.spots);
      last_s_ = f.t_s;
    } else {
      ++repeated_times_;
    }
    listener_.frame(f.index, f.t_s, f.picture, tracker_);
    emit_tracks(this_thread_);
  }
  // Each of those that take the tracks has them in their order.
  void emit_tracks(Pool& pool) {
    std::vector<Track> tracks = tracker_.finished();
    if (tracks.empty()) return;
    const std::function<void(const Track&)> takers[] = {
        [&](const Track& t) { listener_.track(t); }, [&](const Track& t) { statistics_.take(t); },
        [&](const Track& t) { populations_.take(t); }, [&](const Track& t) { links_.track(t); },
        [&](const Track& t) { scores_.take(t); }};
    pool.run_uneven(std::size(takers), [&](std::size_t i) {
      for (const Track& t : tracks) takers[i](t);
    });
    for (Track& t : tracks) drift_.take(std::move(t));  // it keeps them
  }
  // Speeds and mean-square displacements relative to the stage, when it moves.
  void remove_drift() {
    stage_ = drift_.result();
    stage_.removed = stage_.finding == StageFinding::drifting && !options_.keep_drift;
    if (!stage_.removed) return;
    statistics_ = TrackStatistics(survey_.frame_s, options_.interval_frames);
    populations_ = PopulationSurvey(survey_.frame_s);
    for (const Track& t : drift_.tracks()) {
      const Track relative = stage_.relative(t);
      statistics_.take(relative);
      populations_.take(relative);
    }
  }

  const TrackOptions& options_;
  const TrackSurvey& survey_;
  TrackListener& listener_;
  Tracker tracker_;
  LinkCheck links_;
  TrackStatistics statistics_;
  PopulationSurvey populations_;
  TrackScores scores_;
  DriftSurvey drift_;
  StageDrift stage_;
  SpotSums spots_;
  TrackDetection detection_;
  std::optional<DropMask> drop_;
  Pool this_thread_{1};
  double last_s_ = -1;
  std::int64_t repeated_times_ = 0;
};

}  // namespace

TrackMeasurement measure_tracks(const TrackOptions& o, const RunVideo& source, const TrackSurvey& survey,
                                TrackListener& listener, const std::function<void(std::int64_t)>& tick) {
  TrackPass pass(o, survey, listener);
  pass.run(source.file, tick);
  TrackMeasurement m;
  m.video = source.file;
  m.frames = survey.frames;
  m.duration_s = survey.duration_s;
  m.frame_s = survey.frame_s;
  m.timed = survey.timed;
  m.width = survey.first.width;
  m.height = survey.first.height;
  m.um_per_px = source.scale.um_per_px;
  m.um_per_px_source = source.scale.source;
  m.detection = pass.detection();
  m.joining = pass.joining();
  m.summary = pass.summary();
  m.notes = survey.notes;
  if (is_run(o.video) && !is_complete(o.video))
    m.notes.emplace_back("the run was interrupted; the result is based on the recorded part");
  if (pass.repeated_times() > 0)
    m.notes.push_back(fmt::format("{} with the same time as the previous frame: not tracked",
                                  counted(std::uint64_t(pass.repeated_times()), "frame")));
  if (const auto& drop = m.detection.drop)
    m.notes.push_back(fmt::format("drop: centre ({:.0f}, {:.0f}) px, radius {:.0f} px, from the first frame",
                                  drop->centre_image.x, drop->centre_image.y, drop->radius_px));
  if (o.interval_frames > 0 && m.summary.tracks > 0 && m.summary.speed_count == 0)
    m.notes.push_back(fmt::format(
        "--interval is {} frames, but no track has this length (the video has {}): speeds and turns are not "
        "measured; use a smaller interval, or omit the option",
        o.interval_frames, counted(std::uint64_t(survey.frames), "frame")));
  if (survey.frames > 1 && m.summary.tracks == 0)
    m.notes.push_back(m.joining.discarded_tracks == 0
                          ? (o.threshold_sd > 0
                                 ? fmt::format("no tracks were found with a threshold of {:g}; "
                                               "reduce --threshold",
                                               o.threshold_sd)
                                 : std::string("no tracks were found"))
                          : fmt::format("no track has {} (the video has {}); reduce --least",
                                        counted(std::uint64_t(o.tracker.min_points), "detection"),
                                        counted(std::uint64_t(survey.frames), "frame")));
  m.populations = pass.populations(m.summary);
  m.stage = pass.stage();
  m.scores = pass.scores();
  if (m.stage.finding == StageFinding::undecided && mean_order(m.summary) > 0.5)
    m.notes.emplace_back(
        "it cannot be decided whether the common motion is that of the objects or of the stage: no objects "
        "keep "
        "their distances");
  m.warnings = survey.warnings;
  const std::vector<Warning> found = track_warnings(m);
  m.warnings.insert(m.warnings.end(), found.begin(), found.end());
  return m;
}

}  // namespace faba
