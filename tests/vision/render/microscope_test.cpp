#include "vision/render/microscope.h"

#include <doctest/doctest.h>

#include <cmath>
#include <limits>
#include <numbers>
#include <numeric>

#include "core/error.h"
#include "core/random/philox.h"
#include "tests/rendered_video.h"
#include "tests/vision/media.h"
#include "vision/cells/video_ground.h"
#include "vision/files/picture.h"
#include "vision/files/video_reader.h"

using namespace faba;

namespace {

// Relative difference; doctest::Approx uses an absolute tolerance for numbers below 1.
double off(double value, double expected) { return std::fabs(value / expected - 1); }

Frame view(int width = 96, int height = 64) {
  Frame f;
  f.m_per_px = 1e-6;
  f.width = width;
  f.height = height;
  return f;
}

// Uniform light, no noise: only cells and quantisation.
MicroscopeParams still() {
  MicroscopeParams p;
  p.vignetting = 0;
  p.unevenness = 0;
  p.noise = 0.0;
  p.level = 0.8;
  p.contrast = -0.3;
  return p;
}

Image<std::uint16_t> shot(const MicroscopeParams& p, const std::vector<CameraCell>& cells,
                          Frame frame = view(), std::uint64_t number = 0, unsigned threads = 1,
                          std::uint64_t seed = 1) {
  Pool pool(threads);
  Microscope m(p, frame, {}, 1.0 / 15, seed);
  Image<std::uint16_t> out;
  m.render({number, double(number) / 15, cells}, pool, out);
  return out;
}

// Moments of the optical density -ln(grey / ground) of a picture of one cell.
struct Moments {
  double density = 0, x = 0, y = 0, xx = 0, yy = 0, absorbed = 0;
};
Moments moments(const Image<std::uint16_t>& im, double ground) {
  Moments m;
  const auto each = [&](auto&& use) {
    for (int r = 0; r < im.height; ++r)
      for (int c = 0; c < im.width; ++c)
        if (const double grey = im.at(c, r); std::fabs(grey - ground) > 0.51)
          use(c, r, -std::log(grey / ground), ground - grey);
  };
  each([&](int c, int r, double d, double a) {
    m.density += d;
    m.absorbed += a;
    m.x += d * c;
    m.y += d * r;
  });
  m.x /= m.density;
  m.y /= m.density;
  each([&](int c, int r, double d, double) {
    m.xx += d * (c - m.x) * (c - m.x) / m.density;
    m.yy += d * (r - m.y) * (r - m.y) / m.density;
  });
  return m;
}

constexpr double kWhite16 = 65535;
double area_px(const MicroscopeParams& p) {
  const double d = p.cell_diameter / 1e-6, rod = (p.length() - p.cell_diameter) / 1e-6;
  return std::numbers::pi / 4 * d * d + d * rod;
}
double spot_variance(const MicroscopeParams& p) {
  const double d = p.cell_diameter / 1e-6, s = p.psf_sd / 1e-6;
  return s * s + d * d / 16;
}

}  // namespace

TEST_CASE("absorbed light and centroid of a cell do not depend on the sub-pixel position") {
  MicroscopeParams p = still();
  p.psf_sd = 0.6e-6;
  const double ground = std::floor(0.8 * kWhite16 + 0.5);
  double least = 1e9, most = 0;
  for (int i = 0; i < 23; ++i)
    for (int j = 0; j < 7; ++j) {
      const float x = 40 + float(i) / 23, y = 30 + float(j) / 7;
      const Moments m = moments(shot(p, {{x, y}}), ground);
      // The weights of the table are exact to 1e-7; the remaining error is rounding of about 60 pixels to
      // integer levels, 0.3 rms each, against a sum of about 20 000: far below 0.02 px.
      CHECK(std::fabs(m.x - double(x)) < 0.02);
      CHECK(std::fabs(m.y - double(y)) < 0.02);
      // 0.29 sqrt(60) = 2.2 levels rms from rounding, and rounding to zero at the rim
      CHECK(off(m.density, area_px(p) * -std::log(0.7)) < 2e-3);
      least = std::min(least, m.absorbed);
      most = std::max(most, m.absorbed);
    }
  // exp() adds a dependence on the sub-pixel position of exp(-2 pi^2 s^2) with s = 0.5 px: below 1 %
  CHECK((most - least) / most < 0.01);
}

TEST_CASE(
    "width: the point-spread function and the disc add up; a rod and a moving cell are longer along one "
    "axis") {
  MicroscopeParams p = still();
  p.psf_sd = 0.9e-6;
  p.cell_diameter = 2e-6;
  const double ground = std::floor(0.8 * kWhite16 + 0.5), round = spot_variance(p);
  const double pixel = 1.0 / 12;  // variance of the integration over a pixel
  const Moments disc = moments(shot(p, {{40.3F, 30.1F}}), ground);
  // Truncation at 4 sd: 4 * 2 * 4 phi(4) = 1e-3 of the variance is missing.
  CHECK(off(disc.xx, round + pixel) < 4e-3);
  CHECK(off(disc.yy, round + pixel) < 4e-3);

  for (const double displacement : {3.0, 9.0}) {  // variance of n spots: displacement^2 (1 - 1/n^2)/12
    const double n = std::ceil(displacement / (1.2 * std::sqrt(round)));
    const Moments moved = moments(shot(p, {{40.3F, 30.1F, 0, 0, 0, float(displacement)}}), ground);
    CHECK(off(moved.yy, round + pixel + displacement * displacement / 12 * (1 - 1 / (n * n))) < 4e-3);
    CHECK(moved.yy - round - pixel > displacement * displacement / 12 * 0.85);
    CHECK(off(moved.xx, round + pixel) < 4e-3);
    CHECK(off(moved.density, disc.density) < 2e-3);
    CHECK(off(moved.y, 30.1) < 1e-3);  // symmetric about the position at mid-exposure
  }

  p.cell_length = 8e-6;
  const Moments rod = moments(shot(p, {{40.3F, 30.1F, 1, 0}}), ground);
  CHECK(off(rod.xx, round + pixel + 6.0 * 6.0 / 12) < 0.08);
  CHECK(off(rod.yy, round + pixel) < 4e-3);
  CHECK(off(rod.density, area_px(p) * -std::log(0.7)) < 2e-3);
  // Without a heading the cell is round and has the same area.
  const Moments unknown = moments(shot(p, {{40.3F, 30.1F}}), ground);
  CHECK(off(unknown.density, rod.density) < 2e-3);
  CHECK(off(unknown.xx, unknown.yy) < 4e-3);
}

TEST_CASE("cells out of focus are wider and absorb the same light") {
  MicroscopeParams p = still();
  p.depth_spread = 20e-6;
  const double ground = std::floor(0.8 * kWhite16 + 0.5);
  const Moments sharp = moments(shot(still(), {{40, 30}}), ground);
  int wider = 0;
  for (std::uint64_t seed = 1; seed <= 20; ++seed) {
    const Moments m = moments(shot(p, {{40, 30}}, view(), 0, 1, seed), ground);
    CHECK(off(m.density, sharp.density) < 0.01);
    wider += m.xx > 1.5 * sharp.xx;
  }
  CHECK(wider >=
        12);  // beyond a third of the spread: 74 % of the cells; 12 of 20 or fewer has a probability of 1e-2
  CHECK(wider < 20);
}

TEST_CASE("bright cells add light") {
  MicroscopeParams p = still();
  p.level = 0.3;
  p.contrast = 0.5;
  const auto im = shot(p, {{40.2F, 30.4F}});
  double sum = 0;
  for (const auto g : im.px) sum += double(g) - std::floor(0.3 * kWhite16 + 0.5);
  CHECK(off(sum / kWhite16, 0.3 * 0.5 * area_px(p)) < 2e-3);
}

TEST_CASE("noise: zero mean, variance = shot noise in proportion to the light + read noise + rounding") {
  const Frame frame = view(640, 480);
  const double n = 640.0 * 480.0;
  for (const double level : {0.05, 0.2, 0.58, 0.9}) {
    MicroscopeParams p = still();
    p.level = level;
    p.noise.reset();
    Pool pool(1);
    Microscope m(p, frame, {}, 1.0 / 15, 3);
    Gray8 im, next;
    m.render({5, 0, {}}, pool, im);
    m.render({6, 0, {}}, pool, next);
    double mean = 0, variance = 0, neighbour = 0, next_frame = 0;
    for (const auto g : im.px) mean += double(g) / n;
    for (std::size_t i = 0; i < im.px.size(); ++i) {
      const double d = double(im.px[i]) - mean;
      variance += d * d / n;
      if (i + 1 < im.px.size()) neighbour += d * (double(im.px[i + 1]) - mean) / n;
      next_frame += d * (double(next.px[i]) - mean) / n;
    }
    const double expected =
        255.0 * 255.0 * (level / p.full_well + std::pow(p.read_noise / p.full_well, 2)) + 1.0 / 12;
    CAPTURE(level);
    // Five standard errors each; with noise above half a level, the rounding bias is below 1 % of a level.
    CHECK(std::fabs(mean - 255 * level) < 5 * std::sqrt(expected / n) + 0.01);
    CHECK(std::fabs(variance / expected - 1) < 5 * std::sqrt(2 / n) + 0.02);
    CHECK(std::fabs(neighbour) < 5 * expected / std::sqrt(n));
    CHECK(std::fabs(next_frame) < 5 * expected / std::sqrt(n));
    CHECK(m.noise_sd(level) * 255 == doctest::Approx(std::sqrt(expected - 1.0 / 12)));
  }
}

TEST_CASE("uniform noise; lamp drift and flicker") {
  const Frame frame = view(320, 240);
  const auto mean_of = [](const Image<std::uint16_t>& im) {
    return std::accumulate(im.px.begin(), im.px.end(), 0.0) / double(im.px.size()) / kWhite16;
  };
  MicroscopeParams p = still();
  p.noise = 0.01;
  const auto im = shot(p, {}, frame);
  const double mean = mean_of(im);
  double variance = 0;
  for (const auto g : im.px) variance += std::pow(double(g) / kWhite16 - mean, 2) / double(im.px.size());
  CHECK(off(std::sqrt(variance), 0.01) < 5 / std::sqrt(2 * double(im.px.size())));

  p = still();
  p.drift = -0.1;
  CHECK(off(mean_of(shot(p, {}, frame, 30)), 0.8 * 0.8) < 1e-4);  // frame 30 is at t = 2 s
  p = still();
  p.flicker = 0.02;
  double sum = 0, square = 0;
  for (std::uint64_t k = 0; k < 200; ++k) {
    const double lamp = mean_of(shot(p, {}, view(16, 8), k)) / 0.8 - 1;
    sum += lamp;
    square += lamp * lamp;
  }
  CHECK(std::fabs(sum / 200) < 5 * 0.02 / std::sqrt(200.0));
  CHECK(off(std::sqrt(square / 200), 0.02) < 5 / std::sqrt(400.0));
}

TEST_CASE("illumination: vignetting and drop edge match the formulas, unevenness has the given rms") {
  MicroscopeParams p = still();
  p.vignetting = 0.3;
  const Frame frame = view(97, 65);  // odd size: the centre is a pixel
  const GrayF even = Microscope(p, frame, {}, 0.1, 1).ground();
  CHECK(off(double(even.at(48, 32)), 0.8) < 1e-6);
  for (const auto& [c, r] : {std::pair(0, 0), {96, 0}, {0, 64}, {96, 64}})
    CHECK(off(double(even.at(c, r)), 0.8 * 0.7) < 1e-6);
  CHECK(off(double(even.at(48, 0)), 0.8 * (1 - 0.3 * 32 * 32 / (48.0 * 48 + 32 * 32))) < 1e-6);

  p = still();
  p.edge_contrast = -0.5;
  p.outside_level = 0.9;
  p.edge_width = 3e-6;
  p.psf_sd = 4e-6;  // total width 5 px
  const GrayF edge = Microscope(p, view(200, 64), {{-100, 32}, 200}, 0.1, 1).ground();
  CHECK(off(double(edge.at(20, 32)), 0.8) < 1e-4);
  CHECK(off(double(edge.at(199, 32)), 0.8 * 0.9) < 1e-4);
  CHECK(off(double(edge.at(100, 32)), 0.8 * 0.95 * 0.5) < 1e-6);
  CHECK(off(double(edge.at(105, 32)), 0.8 * (1 - 0.1 * 0.841345) * (1 - 0.5 * std::exp(-0.5))) < 1e-5);

  p = still();
  p.unevenness = 0.05;
  double square = 0;
  int count = 0;  // many seeds, because one picture is shorter than a wavelength
  for (std::uint64_t seed = 1; seed <= 40; ++seed) {
    const GrayF ground = Microscope(p, frame, {}, 0.1, seed).ground();
    for (const float g : ground.px) {
      square += std::pow(double(g) / 0.8 - 1, 2);
      ++count;
    }
    for (int c = 1; c < frame.width; ++c)  // slow variation: six waves of at least 97 px
      REQUIRE(std::fabs(double(ground.at(c, 9) - ground.at(c - 1, 9))) <
              0.8 * 0.05 * std::sqrt(2.0 * 6) * 2 * std::numbers::pi / 97);
  }
  CHECK(off(std::sqrt(square / count), 0.05) < 0.2);  // about 2 * 6 * 40 independent phases
}

TEST_CASE("same bytes for 1, 2, 3 and 7 threads, different bytes for another frame or seed") {
  MicroscopeParams p;
  p.depth_spread = 5e-6;
  p.cell_length = 4e-6;
  p.flicker = 0.01;
  std::vector<CameraCell> cells;
  for (std::uint32_t i = 0; i < 3000; ++i) {
    const auto w = draw(5, Stream::start, i, 0);
    cells.push_back({240 * uniform(w[0]) - 15, 200 * uniform(w[1]) - 15, 0.6F, 0.8F, 4 * uniform(w[2]), 1});
  }
  const Frame frame = view(211, 167);
  const auto one = shot(p, cells, frame, 9, 1);
  for (const unsigned threads : {2U, 3U, 7U}) CHECK(shot(p, cells, frame, 9, threads).px == one.px);
  CHECK(shot(p, cells, frame, 9).px == one.px);
  CHECK(shot(p, cells, frame, 10).px != one.px);
  CHECK(shot(p, cells, frame, 9, 1, 2).px != one.px);
}

TEST_CASE("cells at the border and far outside are clipped to the view") {
  MicroscopeParams p = still();
  p.psf_sd = 2e-6;
  const double ground = std::floor(0.8 * kWhite16 + 0.5);
  const double complete = moments(shot(p, {{40, 30}}), ground).density;
  CHECK(off(moments(shot(p, {{-0.5F, 30}}), ground).density, complete / 2) < 0.01);
  CHECK(off(moments(shot(p, {{95.5F, 63.5F}}), ground).density, complete / 4) < 0.01);
  const float none = std::numeric_limits<float>::quiet_NaN(), far = 1e30F;
  const auto empty = shot(p, {});
  CHECK(shot(p, {{-100, 5}, {none, 5}, {far, far}, {-far, 3}, {5, 300}}).px == empty.px);
}

TEST_CASE("quantisation: white is clipped, 8 and 16 bits agree") {
  MicroscopeParams p = still();
  p.level = 1;
  p.contrast = 3;
  Pool pool(1);
  Microscope m(p, view(), {}, 0.1, 1);
  Gray8 low;
  Image<std::uint16_t> high;
  const std::vector<CameraCell> cells{{40, 30}};
  m.render({0, 0, cells}, pool, low);
  m.render({0, 0, cells}, pool, high);
  CHECK(low.at(40, 30) == 255);
  CHECK(high.at(40, 30) == 65535);
  p.level = 0.5;
  p.contrast = -0.5;
  Microscope dim(p, view(), {}, 0.1, 1);
  dim.render({0, 0, cells}, pool, low);
  dim.render({0, 0, cells}, pool, high);
  for (std::size_t i = 0; i < low.px.size(); ++i)
    REQUIRE(std::fabs(double(low.px[i]) / 255 - double(high.px[i]) / 65535) <= 0.501 / 255);
}

TEST_CASE("background and noise from a video") {
  const media::ScratchFolder folder;
  RenderedVideo v;
  v.width = 160;
  v.height = 90;
  v.frames = 60;
  v.microscope.vignetting = 0.4;
  v.microscope.unevenness = 0.05;
  v.microscope.contrast = -0.8;
  v.cells = [](double t) {  // one cell crosses the view
    return std::vector<CameraCell>{{float(10 + 30 * t), 40}};
  };
  write_rendered(v, folder / "real.avi");
  MicroscopeParams p;
  p.background = (folder / "real.avi").string();
  Frame frame = view(160, 90);
  const GrayF truth = Microscope(v.microscope, frame, {}, 1 / v.fps, v.seed).ground();
  const VideoBackground ground = read_video_background(p.background);
  const Microscope m(p, frame, {}, 1 / v.fps, 2, &ground);
  double worst = 0;
  for (std::size_t i = 0; i < truth.px.size(); ++i)
    worst = std::max(worst, double(std::fabs(truth.px[i] - m.ground().px[i])) * 255);
  CHECK(worst <
        6 * 1.25 * 2.1 / std::sqrt(48.0) + 0.5);  // sd of a median of 48 frames, 14 400 pixels, rounding
  // The light decreases by 40 % towards the corners: the noise is between those of corners and centre.
  CHECK(m.noise_sd(0.5) > Microscope(v.microscope, frame, {}, 0.1, 1).noise_sd(0.58 * 0.6));
  CHECK(m.noise_sd(0.5) < Microscope(v.microscope, frame, {}, 0.1, 1).noise_sd(0.58));

  Gray8 still_picture(160, 90, 100);
  write_png(folder / "one.png", still_picture);
  p.background = (folder / "one.png").string();
  const VideoBackground still_ground = read_video_background(p.background);
  const Microscope one(p, frame, {}, 0.1, 1, &still_ground);
  CHECK(double(one.ground().at(80, 40)) == doctest::Approx(100.0 / 255));
  CHECK(one.noise_sd(0.5) == 0);

  p.background = (folder / "real.avi").string();
  frame.width = 161;
  CHECK_THROWS_AS(Microscope(p, frame, {}, 0.1, 1, &ground), Error);
  p.background = (folder / "none.avi").string();
  CHECK_THROWS_AS(read_video_background(folder / "none.avi"), Error);
  CHECK_THROWS_AS(Microscope(p, view(160, 90), {}, 0.1, 1), Error);  // background was not read
}

TEST_CASE("exposure longer than a frame and a cell that fills the view are refused; default exposure") {
  MicroscopeParams p;
  CHECK(Microscope(p, view(), {}, 0.1, 1).exposure_time() == 0.01);
  CHECK(Microscope(p, view(), {}, 0.002, 1).exposure_time() == 0.001);
  p.exposure_time = 0.05;
  CHECK_THROWS_AS(Microscope(p, view(), {}, 0.04, 1), Error);
  p = MicroscopeParams();
  p.psf_sd = 99e-6;
  Frame fine = view();
  fine.m_per_px = 1e-9;
  CHECK_THROWS_AS(Microscope(p, fine, {}, 0.1, 1), Error);
  CHECK_THROWS_AS(Microscope(MicroscopeParams(), view(65536, 65536), {}, 0.1, 1), Error);
}

TEST_CASE("frame times of a rendered video are stored in mp4 and returned by VideoReader") {
  const media::ScratchFolder folder;
  RenderedVideo v;
  v.width = 121;
  v.height = 83;
  v.frames = 12;
  v.time_s = [](long long k) { return double(k) / 15 + (k % 3 == 1 ? 0.011 : 0); };
  write_rendered(v, folder / "v.mp4");
  VideoReader reader(folder / "v.mp4");
  GrayF frame;
  double t = 0;
  int k = 0;
  for (; reader.read(frame, t); ++k) CHECK(std::fabs(t - v.time_s(k)) < 2e-6);
  CHECK(k == 12);
  CHECK(off(reader.fps(), 15) < 0.05);
  CHECK(std::fabs(double(frame.at(60, 40)) - 0.58 * 255) < 12);  // grey at the centre, up to coding and noise
}

TEST_CASE("phase contrast: a halo of the opposite sign around a cell, and the mean light for halo = 1") {
  MicroscopeParams p = still();
  p.mode = MicroscopeParams::Mode::phase_contrast;
  p.halo = 1;
  p.halo_width = 4e-6;
  const double ground = std::floor(0.8 * kWhite16 + 0.5);
  const Image<std::uint16_t> im = shot(p, {{48, 32}});
  CHECK(im.at(48, 32) < 0.9 * ground);
  CHECK(im.at(54, 32) > 1.001 * ground);
  double density = 0, of_halo = 0, variance = 0;
  for (int r = 0; r < im.height; ++r)
    for (int c = 0; c < im.width; ++c) density -= std::log(double(im.at(c, r)) / ground);
  CHECK(std::fabs(density) < 2e-3 * area_px(p) * -std::log(0.7) + 0.01);  // rounding, see above
  // Without the cell itself the halo is a Gaussian of its width, the blur and the disc.
  MicroscopeParams bright = p;
  bright.mode = MicroscopeParams::Mode::bright_field;
  const Image<std::uint16_t> cell = shot(bright, {{48, 32}});
  for (int r = 0; r < im.height; ++r)
    for (int c = 0; c < im.width; ++c) {
      const double d = std::log(double(im.at(c, r)) / double(cell.at(c, r)));
      of_halo += d;
      variance += d * (c - 48) * (c - 48);
    }
  CHECK(off(of_halo, area_px(p) * -std::log(0.7)) < 0.01);
  CHECK(off(variance / of_halo, spot_variance(p) + 16 + 1.0 / 12) < 0.02);
  // A bright cell has a dark halo; the light stays above zero where halos overlap.
  p.contrast = 5;
  const std::vector<CameraCell> crowd(400, CameraCell{48, 32});
  CHECK(shot(p, {{48, 32}}).at(54, 32) < ground);
  CHECK(shot(p, crowd).at(54, 32) < 0.1 * ground);
  CHECK(shot(p, crowd).at(54, 32) > 0);
}

TEST_CASE("fluorescence: bright cells on a dark background that bleach exponentially, with shot noise") {
  MicroscopeParams p = still();
  p.mode = MicroscopeParams::Mode::fluorescence;
  p.emission = 0.5;
  p.background_emission = 0.05;
  p.bleaching_time = 2;
  const double ground = std::floor(0.05 * kWhite16 + 0.5);
  const auto emitted = [&](std::uint64_t number) {  // time: number / 15 s
    const Image<std::uint16_t> im = shot(p, {{48, 32}}, view(), number);
    return std::accumulate(im.px.begin(), im.px.end(), 0.0) - ground * double(im.px.size());
  };
  CHECK(off(emitted(0), area_px(p) * 0.5 * kWhite16) < 2e-3);
  CHECK(off(emitted(30) / emitted(0), std::exp(-1.0)) < 2e-3);       // one time constant
  CHECK(shot(p, {}, view(), 30).at(5, 5) == std::uint16_t(ground));  // the background does not bleach

  p.noise.reset();
  p.read_noise = 0;
  p.full_well = 1000;
  const Image<std::uint16_t> im = shot(p, {});
  double sum = 0, squares = 0;
  for (const std::uint16_t v : im.px) {
    sum += v;
    squares += double(v) * v;
  }
  const auto n = double(im.px.size());
  const double variance = squares / n - sum * sum / (n * n);
  // Relative standard error of a variance of 6144 values: sqrt(2/6144) = 1.8 %.
  CHECK(off(variance, 0.05 / 1000 * kWhite16 * kWhite16) < 0.08);
}

TEST_CASE("the parameters of other modes do not change a bright-field picture") {
  MicroscopeParams p, q;
  q.halo = 0.3;
  q.halo_width = 9e-6;
  q.emission = 2;
  q.bleaching_time = 0.1;
  const std::vector<CameraCell> cells{{40, 30}, {70.5F, 20.25F}};
  CHECK(shot(p, cells, view(), 3).px == shot(q, cells, view(), 3).px);
}
