// Counts, speeds and directions of cells with known motion in rendered videos of each imaging mode, and in
// coded videos.
#include <doctest/doctest.h>

#include <array>
#include <cmath>

#include "study/data/flow_choice.h"
#include "study/motion/activity.h"
#include "study/pages/tracks/track_report.h"
#include "tests/rendered_video.h"
#include "tests/vision/media.h"
#include "tests/vision/rendered_cells.h"

using namespace faba;

namespace {

constexpr int kCells = 40;
constexpr double kSpeed = 30;  // px/s

// Cells that swim straight on at one speed, on a torus of the size of the picture without its margins: no
// cell enters or leaves within the video unless it wraps.
RenderedVideo swimmers(const MicroscopeParams& microscope, std::uint64_t seed) {
  RenderedVideo v;
  v.frames = 20;
  v.microscope = microscope;
  v.seed = seed;
  cells::Dice dice(seed + 100);
  std::vector<std::array<double, 3>> starts;
  while (starts.size() < kCells) {
    const std::array<double, 3> s{50 + 220 * dice.uniform(), 50 + 140 * dice.uniform(),
                                  6.2832 * dice.uniform()};
    bool apart = true;
    for (const auto& other : starts) apart = apart && std::hypot(s[0] - other[0], s[1] - other[1]) > 14;
    if (apart) starts.push_back(s);
  }
  v.cells = [starts](double t) {
    std::vector<CameraCell> all;
    for (const auto& s : starts)
      all.push_back({float(s[0] + kSpeed * t * std::cos(s[2])), float(s[1] + kSpeed * t * std::sin(s[2]))});
    return all;
  };
  return v;
}

TrackMeasurement tracked(const RenderedVideo& v, const char* name) {
  const media::ScratchFolder folder;
  write_rendered(v, folder / name);
  TrackOptions o;
  o.video = folder / name;
  o.threads = 1;
  return track_video(o);
}

// The number of cells within 5 % and their speed within 2 %; a few cells cross.
void check_truth(const TrackMeasurement& m, Polarity polarity) {
  CHECK(m.detection.polarity == polarity);
  CHECK(m.detection.spots_per_frame == doctest::Approx(kCells).epsilon(0.05));
  CHECK(m.summary.mean_speed_px_s.value == doctest::Approx(kSpeed).epsilon(0.02));
  CHECK(quality_of(m.warnings) == Quality::good);
  for (const Warning& w : m.warnings) MESSAGE(sentence(w));
}

MicroscopeParams mode(MicroscopeParams::Mode which) {
  MicroscopeParams p;
  p.mode = which;
  return p;
}

}  // namespace

TEST_CASE("track: cells in phase contrast, dark or bright, with their halos") {
  MicroscopeParams p = mode(MicroscopeParams::Mode::phase_contrast);
  check_truth(tracked(swimmers(p, 1), "v.avi"), Polarity::dark);
  p.contrast = 0.6;
  check_truth(tracked(swimmers(p, 2), "v.avi"), Polarity::bright);
}

TEST_CASE("track: cells in fluorescence, also while they bleach to a fourth") {
  MicroscopeParams p = mode(MicroscopeParams::Mode::fluorescence);
  check_truth(tracked(swimmers(p, 3), "v.avi"), Polarity::bright);
  p.bleaching_time = 1;
  check_truth(tracked(swimmers(p, 4), "v.avi"), Polarity::bright);
}

TEST_CASE("track: cells below one level of 8 bits are found in 16 bits") {
  MicroscopeParams p;
  p.contrast = -0.01;
  p.noise = 0.0002;  // 13 of 65535 levels, a twentieth of a level of 8 bits
  p.bits = 16;
  const RenderedVideo v = swimmers(p, 7);
  const media::ScratchFolder folder;
  Frame frame;
  frame.m_per_px = v.m_per_px;
  frame.width = v.width;
  frame.height = v.height;
  Pool pool(1);
  Microscope microscope(p, frame, {}, 1 / v.fps, v.seed);
  VideoWriter writer(folder / "v.part", VideoFormat::lossless_avi, v.width, v.height, v.fps, 0,
                     VideoPixels::grey16);
  Image<std::uint16_t> picture;
  for (int k = 0; k < v.frames; ++k) {
    const std::vector<CameraCell> cells = v.cells(v.time_of(k));
    microscope.render({std::uint64_t(k), v.time_of(k), cells}, pool, picture);
    writer.write(picture);
  }
  writer.finish(folder / "v.avi");
  TrackOptions o;
  o.video = folder / "v.avi";
  o.threads = 1;
  check_truth(track_video(o), Polarity::dark);
}

TEST_CASE("track: a coded video of a camera without noise has the cells and not the artefacts") {
  MicroscopeParams p;
  p.noise = 0.0025;
  const TrackMeasurement lossless = tracked(swimmers(p, 5), "v.avi"),
                         coded = tracked(swimmers(p, 5), "v.mp4");
  CHECK_FALSE(lossless.detection.coding.coded());
  CHECK(coded.detection.coding.coded());
  CHECK(coded.detection.coding.unchanged > 0.05);
  check_truth(lossless, Polarity::dark);
  check_truth(coded, Polarity::dark);
}

TEST_CASE("track: faint cells in a coded video are not counted twice, or the quality is not good") {
  for (const double contrast : {-0.15, -0.08}) {
    MicroscopeParams p;
    p.noise = 0.0025;
    p.contrast = contrast;
    const TrackMeasurement m = tracked(swimmers(p, 6), "v.mp4");
    INFO(contrast << ": " << m.detection.spots_per_frame << " spots, SNR "
                  << m.detection.median_snr.value_or(0));
    const bool right = std::fabs(m.detection.spots_per_frame / kCells - 1) < 0.1 &&
                       std::fabs(m.summary.mean_speed_px_s.value / kSpeed - 1) < 0.1;
    CHECK((right || quality_of(m.warnings) != Quality::good));
  }
}

// Half of the video to the right, then down, as after a turn of the field.
TEST_CASE("activity: the directions of motion in phase contrast and in fluorescence") {
  for (const auto which : {MicroscopeParams::Mode::phase_contrast, MicroscopeParams::Mode::fluorescence}) {
    MicroscopeParams p = mode(which);
    if (which == MicroscopeParams::Mode::fluorescence) p.bleaching_time = 2;
    RenderedVideo v = swimmers(p, 8);
    v.frames = 32;
    const std::vector<CameraCell> starts = v.cells(0);
    v.cells = [starts](double t) {
      std::vector<CameraCell> all = starts;
      for (CameraCell& c : all) {
        c.x += float(kSpeed / 2 * std::min(t, 1.0));
        c.y += float(kSpeed / 2 * std::max(t - 1.0, 0.0));
      }
      return all;
    };
    const media::ScratchFolder folder;
    write_rendered(v, folder / "v.avi");
    ActivityJob job;
    job.videos = {{folder / "v.avi"}};
    job.method = flow_part({}, published_flow());
    job.cells = false;
    job.threads = 1;
    const VideoActivity a = measure_activity(job).videos.at(0);
    REQUIRE(a.segments.size() == 2);
    CHECK(std::fabs(std::remainder(a.segments[0].direction_deg, 360)) < 10);
    CHECK(std::fabs(std::remainder(a.segments[1].direction_deg - 90, 360)) < 10);
    CHECK(std::fabs(a.segments[1].t0_s - 1) < 0.2);
  }
}
