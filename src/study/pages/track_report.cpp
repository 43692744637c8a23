#include "study/pages/track_report.h"

#include <algorithm>
#include <cmath>
#include <string>
#include <system_error>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include "core/counted.h"
#include "core/error.h"
#include "core/file.h"
#include "core/statistics.h"
#include "core/toml.h"
#include "study/data/run_video.h"
#include "study/pages/track_figures.h"
#include "study/pages/track_page.h"
#include "study/tracks/swarm_output.h"
#include "study/tracks/track_json.h"
#include "study/tracks/track_output.h"
#include "study/tracks/track_survey.h"
#include "vision/draw/track_picture.h"
#include "vision/drop/drop_edge.h"
#include "vision/files/picture.h"
#include "vision/files/video_reader.h"
#include "vision/files/video_writer.h"

namespace faba {
namespace {

constexpr std::size_t kTail = 30;     // places behind each cell in the overlay
constexpr double kRing = 5;           // px between a cell and the ring around it
constexpr std::size_t kDrawn = 3000;  // tracks on the picture of all tracks: more cannot be told apart
constexpr std::size_t kDrawnPoints = 300000;

// Overlay video under a temporary name, which is gone unless complete() is called.
class Overlay {
 public:
  Overlay(std::filesystem::path path, const TrackSurvey& s)
      : path_(std::move(path)),
        survey_(s),
        writer_(part(), path_.extension() == ".avi" ? VideoFormat::lossless_avi : VideoFormat::mp4,
                s.first.width, s.first.height,
                std::clamp(s.timed ? 1 / s.frame_s : 25.0, kSlowestVideo, kFastestVideo)),
        tail_px_(std::max(10.0, std::sqrt(double(s.first.width) * s.first.height /
                                          double(std::max<std::int64_t>(1, s.spots))))) {}
  ~Overlay() {
    std::error_code ignored;
    if (!whole_) std::filesystem::remove(part(), ignored);
  }
  void write(const GrayF& frame, std::uint64_t index, const Tracker& tracker) {
    std::vector<TrackLine> lines;
    for (const Track* t : tracker.live()) {
      TrackLine line{t->number, {}, !t->points.empty() && t->points.back().frame == index};
      // The last places, newest first, as far back as another cell would be met.
      double length = 0;
      for (std::size_t i = t->points.size(); i-- > 0 && line.path.size() < kTail && length <= tail_px_;) {
        const Vec2 at{t->points[i].x_px, t->points[i].y_px};
        if (!line.path.empty()) length += norm(at - line.path.back());
        line.path.push_back(at);
      }
      std::reverse(line.path.begin(), line.path.end());
      lines.push_back(std::move(line));
    }
    writer_.write(draw_tracks(frame, survey_.black, survey_.white, lines, true, survey_.size_px + kRing));
  }
  void complete() {
    writer_.finish(path_);
    whole_ = true;
  }

 private:
  std::filesystem::path part() const { return path_.string() + ".part"; }
  std::filesystem::path path_;
  const TrackSurvey& survey_;
  VideoWriter writer_;
  double tail_px_;  ///< longest path behind a cell
  bool whole_ = false;
};

std::optional<DropMask> drop_of(const TrackOptions& o, const TrackSurvey& s) {
  if (!o.inside_drop) return {};
  DropEdgeOptions edge_options;
  edge_options.name = o.video.string();
  const DropEdge edge = find_drop_edge(s.first, edge_options);
  return DropMask{edge.centre_image, edge.radius_px, edge.centre_side_inside, s.size_px};
}

// The second pass.
class Pass {
 public:
  Pass(const TrackOptions& o, const RunVideo& source, const TrackSurvey& s)
      : options_(o),
        survey_(s),
        source_(source),
        tracker_(o.tracker),
        statistics_(s.frame_s, o.interval_frames),
        drop_(drop_of(o, s)) {
    for (const auto& path : o.out)
      outputs_.push_back(track_output(path, {s.first.width, s.first.height, source.um_per_px.value_or(0)}));
    if (!o.overlay.empty()) overlay_ = std::make_unique<Overlay>(o.overlay, s);
  }

  void run(const std::function<void(std::int64_t)>& tick) {
    VideoReader reader(source_.file, options_.fps);
    Detector detector(survey_.background, detector_options(options_, survey_, drop_));
    threshold = detector.threshold_sd();
    if (!options_.swarm.empty())
      swarm_ = std::make_unique<SwarmOutput>(options_.swarm, survey_, reader.bits());
    GrayF frame;
    double t_s = 0, last = -1;
    for (std::uint64_t index = 0; reader.read(frame, t_s); ++index) {
      make_finite(frame);
      if (!survey_.temporal)
        detector = Detector(spatial_background(frame, survey_.smoothing_px),
                            detector_options(options_, survey_, drop_));
      const std::vector<Spot> spots = detector.find(frame);
      count_spots(spots);
      if (t_s > last) {
        tracker_.take(index, t_s, spots);
        last = t_s;
      } else {
        ++repeated_times;
      }
      if (overlay_) overlay_->write(frame, index, tracker_);
      if (swarm_) swarm_->write(index, t_s, frame);
      hand_out();
      tick(std::int64_t(index) + 1);
    }
    tracker_.finish();
    hand_out();
  }
  void complete() {
    for (const auto& out : outputs_) out->complete();
    if (overlay_) overlay_->complete();
    if (swarm_) swarm_->complete();
  }

  TrackSummary summary() { return statistics_.summary(); }
  const Tracker& tracker() const { return tracker_; }
  const std::vector<TrackLine>& drawn() const { return drawn_; }
  const std::optional<DropMask>& drop() const { return drop_; }

  double threshold = 0, spots_found = 0, frames = 0, elongation = 0, place_sd = 0;
  std::int64_t repeated_times = 0;

 private:
  void count_spots(const std::vector<Spot>& found) {
    ++frames;
    spots_found += double(found.size());
    for (const Spot& s : found) elongation += s.elongation, place_sd += s.sd_px;
  }
  void hand_out() {
    for (const Track& t : tracker_.finished()) {
      for (const auto& out : outputs_) out->write(t);
      statistics_.take(t);
      if (drawn_.size() >= kDrawn || drawn_points_ + t.points.size() > kDrawnPoints) continue;
      drawn_points_ += t.points.size();
      TrackLine line{t.number, {}, false};
      for (const TrackPoint& p : t.points) line.path.push_back({p.x_px, p.y_px});
      drawn_.push_back(std::move(line));
    }
  }

  const TrackOptions& options_;
  const TrackSurvey& survey_;
  const RunVideo& source_;
  Tracker tracker_;
  TrackStatistics statistics_;
  std::optional<DropMask> drop_;
  std::vector<std::unique_ptr<TrackOutput>> outputs_;
  std::unique_ptr<Overlay> overlay_;
  std::unique_ptr<SwarmOutput> swarm_;
  std::vector<TrackLine> drawn_;
  std::size_t drawn_points_ = 0;
};

const char* word_of(Polarity p) {
  return p == Polarity::bright ? "bright" : p == Polarity::both ? "both" : "dark";
}

Json found_json(const TrackSurvey& s, const Pass& pass, const TrackOptions& o) {
  const double n = std::max(1.0, pass.spots_found);
  std::vector<float> noise = s.background.noise_sd.px;
  Json d{{"size_px", s.size_px},
         {"polarity", word_of(s.polarity)},
         {"background", s.temporal ? "median" : "spatial"},
         {"background_frames", s.background.frames},
         {"noise_grey", robust_spread_low(noise).median},
         {"threshold_snr", pass.threshold},
         {"spots_per_frame", pass.spots_found / std::max(1.0, pass.frames)},
         {"still_spots", s.still_spots},
         {"mean_place_sd_px", pass.spots_found > 0 ? Json(pass.place_sd / n) : Json(nullptr)},
         {"mean_elongation", pass.spots_found > 0 ? Json(pass.elongation / n) : Json(nullptr)}};
  if (pass.drop()) {
    d["drop_center_px"] = {pass.drop()->centre_image.x, pass.drop()->centre_image.y};
    d["drop_radius_px"] = pass.drop()->radius_px;
  }
  Json j;
  j["detection"] = d;
  j["tracking"] = {{"reach_px", pass.tracker().reach_px()},
                   {"motion", pass.tracker().motion() == Motion::velocity ? "velocity" : "nearest"},
                   {"memory_frames", o.tracker.memory},
                   {"least_points", o.tracker.least_points},
                   {"unsure_tracks", pass.tracker().unsure_tracks()}};
  return j;
}

}  // namespace

nlohmann::ordered_json track_video(const TrackOptions& o, const TrackProgress& progress) {
  RunVideo source = run_video(o.video);
  if (o.um_per_px) source.um_per_px = o.um_per_px;
  const double um_per_px = source.um_per_px.value_or(0);  // 0: not known
  std::int64_t total = 0;
  const auto tick = [&](std::int64_t done) {
    if (progress && !progress(done, total))
      throw Error(Errc::interrupted, o.video.string(), "stopped before its end; nothing was written");
  };
  const TrackSurvey survey = survey_tracks(o, source.file, [&](std::int64_t done, std::int64_t stated) {
    total = 2 * stated;
    tick(done);
  });
  total = 2 * survey.frames;
  Pass pass(o, source, survey);
  pass.run([&](std::int64_t done) { tick(survey.frames + done); });
  const TrackSummary summary = pass.summary();

  Json j{{"video", source.file.string()},
         {"frames", survey.frames},
         {"duration_s", survey.duration_s},
         {"frame_s", survey.frame_s},
         {"timed", survey.timed},
         {"image_size", {survey.first.width, survey.first.height}},
         {"um_per_px", um_per_px > 0 ? Json(um_per_px) : Json(nullptr)}};
  j.update(found_json(survey, pass, o));
  j["tracks"] = summary.tracks;
  j["points"] = summary.points;
  j["mean_points"] = summary.mean_points;
  j.update(track_json(summary, um_per_px));
  Json notes = survey.notes;
  if (is_run(o.video) && !is_whole(o.video))
    notes.push_back("the run was interrupted; this is what was recorded");
  if (pass.repeated_times > 0)
    notes.push_back(fmt::format("{} at the time of the one before: not tracked",
                                counted(std::uint64_t(pass.repeated_times), "frame")));
  // Cells that are joined over a quarter of the mean spacing and more are often the wrong ones.
  const double spacing = std::sqrt(double(survey.first.width) * survey.first.height /
                                   std::max(1.0, pass.spots_found / pass.frames));
  const double step = summary.speed_count > 0 ? summary.mean_speed_px_s.value * survey.frame_s : 0;
  // Steps that agree in direction for less than two frames are steps to the wrong cells.
  const bool forgetful = j["supported"] == "persistent_walk" && !summary.persistent.tau_open &&
                         (!summary.persistent.good || summary.tau_s.value < 1.5 * survey.frame_s);
  if (pass.tracker().crowded() || step > 0.3 * spacing)
    notes.push_back(
        "cells move about as far between frames as they are apart: many tracks join different cells, and "
        "speeds are too small; record more frames per second, or fewer cells");
  else if (forgetful)
    notes.push_back(
        "directions last for less than two frames: cells turn faster than the camera looks, or tracks join "
        "different "
        "cells; speeds are too small");
  if (survey.frames > 1 && summary.tracks == 0) notes.push_back("nothing was tracked");
  j["notes"] = notes;

  const RgbImage picture = draw_tracks(survey.first, survey.black, survey.white, pass.drawn(), false, 0);
  const std::vector<Figure> figures = track_figures(summary, um_per_px);
  pass.complete();
  if (!o.picture.empty()) write_png(o.picture, picture);
  if (!o.figures.empty())
    write_track_figures(o.figures, figures, path_plot(pass.drawn(), survey.first.width, survey.first.height));
  if (!o.report.empty()) write_file(o.report, track_page(j, figures, picture));
  return j;
}

}  // namespace faba
