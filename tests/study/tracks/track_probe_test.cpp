#include "study/tracks/track_probe.h"

#include <doctest/doctest.h>

#include <algorithm>
#include <cmath>
#include <string>

#include "core/error.h"
#include "core/file.h"
#include "study/tracks/track_measurement.h"
#include "tests/temporary_folder.h"
#include "tests/vision/rendered_cells.h"

using namespace faba;

namespace {

constexpr int kFrames = 70;  // more than the 50 that the background uses at most
constexpr int kMoving = 25;

// Moving cells, and some that do not move in half of the tests.
std::filesystem::path film(const std::filesystem::path& folder, int still) {
  const std::filesystem::path out = folder / "film";
  std::filesystem::create_directories(out);
  cells::Look l;
  const std::vector<Vec2> start = cells::scattered(l, kMoving + still, 20, 10, 3);
  for (int k = 0; k < kFrames; ++k) {
    std::vector<Vec2> at = start;
    for (int i = 0; i < kMoving; ++i) at[std::size_t(i)].x += 1.5 * k;
    const Gray8 b = cells::bytes(cells::picture(l, at, std::uint64_t(k)));
    write_file(out / (std::string(k < 10 ? "f0" : "f") + std::to_string(k) + ".pgm"),
               "P5\n320 240\n255\n" + std::string(b.px.begin(), b.px.end()));
  }
  return out;
}

using Place = std::array<double, 3>;  // x, y, signal-to-noise ratio

// All detections of a frame when the complete video is tracked: with tracks of one detection none is lost.
class FrameDetections final : public TrackListener {
 public:
  explicit FrameDetections(std::uint64_t frame) : frame_(frame) {}
  void frame(std::uint64_t, double, const GrayF&, const Tracker&) override {}
  void track(const Track& t) override {
    for (const TrackPoint& p : t.points)
      if (p.frame == frame_) places.push_back({p.x_px, p.y_px, p.snr});
  }
  std::vector<Place> places;

 private:
  std::uint64_t frame_;
};

std::vector<Place> tracked(TrackOptions o, std::int64_t frame) {
  o.tracker.min_points = 1;
  const RunVideo source = run_video(o.video);
  const TrackSurvey survey = survey_tracks(o, source.file, [](auto, auto) {});
  FrameDetections found{std::uint64_t(frame)};
  (void)measure_tracks(o, source, survey, found, [](auto) {});
  std::sort(found.places.begin(), found.places.end());
  return found.places;
}

std::vector<Place> probed(TrackProbe& probe, const TrackOptions& o, std::int64_t frame) {
  std::vector<Place> places;
  for (const Spot& s : probe.detect(o, frame).spots) places.push_back({s.x_px, s.y_px, s.snr});
  std::sort(places.begin(), places.end());
  return places;
}

}  // namespace

TEST_CASE("track probe: the detections of a frame are those of the tracking of the complete video") {
  for (const int still : {0, 60}) {
    CAPTURE(still);
    const test::TemporaryFolder folder("probe");
    TrackOptions o;
    o.video = film(folder.path(), still);
    o.part.fps = 20;
    o.threads = 1;
    TrackProbe probe(o, run_video(o.video), [](auto, auto) { return true; });
    CHECK(probe.frames().stated() == kFrames);
    std::vector<TrackOptions> all(5, o);
    all[1].size_px = 5;
    all[2].threshold_sd = 25;
    all[3].polarity = Polarity::bright;
    all[3].threshold_sd = 3;
    all[4].background = still ? BackgroundKind::median : BackgroundKind::spatial;
    // In an order in which the reader also goes back.
    for (const std::int64_t frame : {40, 3, 69})
      for (std::size_t i = 0; i < all.size(); ++i) {
        CAPTURE(frame);
        CAPTURE(i);
        const std::vector<Place> places = probed(probe, all[i], frame);
        CHECK(places == tracked(all[i], frame));
        // Some cells have left the picture in the last frames.
        if (i == 0) CHECK(places.size() >= std::size_t(kMoving) / 2);
      }
  }
}

TEST_CASE("track probe: links over some frames, cancelling, and frames that do not exist") {
  const test::TemporaryFolder folder("probe");
  TrackOptions o;
  o.video = film(folder.path(), 0);
  o.part.fps = 20;
  TrackProbe probe(o, run_video(o.video), [](auto, auto) { return true; });
  const ProbedLinks links = probe.link(o, 10, 8);
  CHECK(links.frames == 8);
  CHECK(links.tracks.size() >= std::size_t(kMoving) * 8 / 10);
  for (const Track& t : links.tracks)
    for (std::size_t i = 1; i < t.points.size(); ++i) {
      CHECK(t.points[i].frame >= 10);
      const double step =
          (t.points[i].x_px - t.points[i - 1].x_px) / double(t.points[i].frame - t.points[i - 1].frame);
      CHECK(std::fabs(step - 1.5) < 0.5);
    }
  CHECK(probe.link(o, kFrames - 3, 8).frames == 3);
  CHECK_THROWS_AS((void)probe.detect(o, kFrames), Error);
  CHECK_THROWS_AS((void)probe.detect(o, -1), Error);
  CHECK(probe.detect(o, 0).index == 0);  // still usable
  CHECK_THROWS_AS(TrackProbe(o, run_video(o.video), [](auto done, auto) { return done < 3; }), Error);
}
