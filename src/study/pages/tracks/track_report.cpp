#include "study/pages/tracks/track_report.h"

#include <algorithm>
#include <cmath>
#include <memory>
#include <string>
#include <system_error>

#include "core/error.h"
#include "core/file.h"
#include "study/pages/tracks/swarm_output.h"
#include "study/pages/tracks/track_figures.h"
#include "study/pages/tracks/track_output.h"
#include "study/pages/tracks/track_page.h"
#include "vision/draw/track_picture.h"
#include "vision/files/picture.h"
#include "vision/files/video_writer.h"

namespace faba {
namespace {

constexpr std::size_t kTail = 30;     // positions behind each cell in the overlay
constexpr double kRing = 5;           // px between a cell and the ring around it
constexpr std::size_t kDrawn = 3000;  // tracks on the picture of all tracks; more are not distinguishable
constexpr std::size_t kDrawnPoints = 300000;

// Overlay video under a temporary name; deleted unless complete() is called.
class Overlay {
 public:
  Overlay(std::filesystem::path path, const TrackSurvey& s)
      : path_(std::move(path)),
        survey_(s),
        writer_(part(), path_.extension() == ".avi" ? VideoFormat::lossless_avi : VideoFormat::mp4,
                s.first.width, s.first.height,
                std::clamp(s.timed ? 1 / s.frame_s : 25.0, kMinFrameRate, kMaxFrameRate)),
        tail_px_(std::max(10.0, std::sqrt(double(s.first.width) * s.first.height /
                                          double(std::max<std::int64_t>(1, s.spots))))) {}
  ~Overlay() {
    std::error_code ignored;
    if (!complete_) std::filesystem::remove(part(), ignored);
  }
  void write(const GrayF& frame, std::uint64_t index, const Tracker& tracker) {
    std::vector<TrackLine> lines;
    for (const Track* t : tracker.live()) {
      TrackLine line{t->number, {}, !t->points.empty() && t->points.back().frame == index};
      // The last positions, newest first, limited to the mean distance between cells.
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
    complete_ = true;
  }

 private:
  std::filesystem::path part() const { return path_.string() + ".part"; }
  std::filesystem::path path_;
  const TrackSurvey& survey_;
  VideoWriter writer_;
  double tail_px_;  ///< longest path behind a cell
  bool complete_ = false;
};

// The files that are written during tracking, and the paths for the pictures at the end.
class TrackFiles final : public TrackListener {
 public:
  TrackFiles(const TrackOptions& o, const RunVideo& source, const TrackSurvey& s) {
    for (const TrackTable& table : o.out)
      outputs_.push_back(
          track_output(table, {s.first.width, s.first.height, source.scale.um_per_px, s.timed}));
    if (!o.overlay.empty()) overlay_ = std::make_unique<Overlay>(o.overlay, s);
    if (!o.swarm.empty()) swarm_ = std::make_unique<SwarmOutput>(o.swarm, s, s.bits);
  }
  void frame(std::uint64_t index, double t_s, const GrayF& frame, const Tracker& tracker) override {
    if (overlay_) overlay_->write(frame, index, tracker);
    if (swarm_) swarm_->write(index, t_s, frame);
  }
  void track(const Track& t) override {
    for (const auto& out : outputs_) out->write(t);
    if (drawn_.size() >= kDrawn || drawn_points_ + t.points.size() > kDrawnPoints) return;
    drawn_points_ += t.points.size();
    TrackLine line{t.number, {}, false};
    for (const TrackPoint& p : t.points) line.path.push_back({p.x_px, p.y_px});
    drawn_.push_back(std::move(line));
  }
  void complete() {
    for (const auto& out : outputs_) out->complete();
    if (overlay_) overlay_->complete();
    if (swarm_) swarm_->complete();
  }
  const std::vector<TrackLine>& drawn() const { return drawn_; }

 private:
  std::vector<std::unique_ptr<TrackOutput>> outputs_;
  std::unique_ptr<Overlay> overlay_;
  std::unique_ptr<SwarmOutput> swarm_;
  std::vector<TrackLine> drawn_;
  std::size_t drawn_points_ = 0;
};

}  // namespace

TrackMeasurement track_video(const TrackOptions& o, const TrackProgress& progress) {
  RunVideo source = run_video(o.video);
  const std::string overridden = override_note(o.video, source, o.part.fps, o.scale.um_per_px);
  const std::string ignored = source.scale.ignored;
  if (o.scale.um_per_px) source.scale = o.scale;
  std::int64_t total = 0;
  const auto tick = [&](std::int64_t done) {
    if (progress && !progress(done, total))
      throw Error(Errc::interrupted, o.video.string(), "stopped before the end; no file was written");
  };
  const TrackSurvey survey = survey_tracks(o, source.file, [&](std::int64_t done, std::int64_t stated) {
    total = 2 * stated;
    tick(done);
  });
  total = 2 * survey.frames;
  TrackFiles files(o, source, survey);
  TrackMeasurement m =
      measure_tracks(o, source, survey, files, [&](std::int64_t done) { tick(survey.frames + done); });
  for (const std::string& note : {overridden, ignored})
    if (!note.empty()) m.notes.push_back(note);
  const RgbImage picture = draw_tracks(survey.first, survey.black, survey.white, files.drawn(), false, 0);
  const std::vector<Figure> figures = track_figures(m.summary, m.um_per_px.value_or(0), m.populations);
  files.complete();
  if (!o.picture.empty()) write_png(o.picture, picture);
  if (!o.figures.empty())
    write_track_figures(o.figures, figures, path_plot(files.drawn(), m.width, m.height));
  if (!o.per_track.empty()) write_file(o.per_track, per_track_csv(m.scores));
  if (!o.report.empty()) write_file(o.report, track_page(m, figures, picture, o.provenance));
  return m;
}

}  // namespace faba
