#include "vision/ruler/ruler.h"

#include <doctest/doctest.h>

#include <cmath>
#include <limits>
#include <string>

#include "core/error.h"
#include "tests/vision/ruler_pictures.h"
#include "vision/draw/ruler_overlay.h"
#include "vision/files/picture.h"

using namespace faba;

namespace {

// Half width of the 95 % confidence interval: Student's t for n - 2 degrees of freedom, to 1 % (Abramowitz
// and Stegun 26.7.5).
double interval_half_width(const MarkRow& row) {
  const double f = row.used() - 2, z = 1.96;
  return (z + (z * z * z + z) / (4 * f) + (5 * std::pow(z, 5) + 16 * std::pow(z, 3) + 3 * z) / (96 * f * f)) *
         row.se_pitch_px;
}

std::string refusal(const GrayF& picture) {
  try {
    const Ruler r = find_ruler(picture);
    return "found a pitch of " + std::to_string(r.row.pitch_px);
  } catch (const Error& e) {
    CHECK(e.code() == Errc::input);
    return e.what();
  }
}

bool message_contains(const std::string& text, const char* words) {
  return text.find(words) != std::string::npos;
}

/// The measured pitch, 0 when there is an error; captures the scene for the log.
double pitch_of(const RulerScene& s) {
  CAPTURE(s.seed);
  CAPTURE(s.pitch);
  CAPTURE(s.angle_deg);
  try {
    return find_ruler(render(s)).row.pitch_px;
  } catch (const Error& e) {
    FAIL_CHECK(e.what());
    return 0;
  }
}

}  // namespace

TEST_CASE("without noise the measured marks are at the drawn positions") {
  RulerScene s;
  s.noise = 0;
  s.bits = 16;
  s.angle_deg = 17;
  s.pitch = 12.37;
  s.first = -12;
  s.last = 14;
  const GrayF picture = render(s);
  const Ruler r = find_ruler(picture);
  // Grey steps of 1/16 over a contrast of 120 move the centroid of a mark by about 1e-3 px at most.
  CHECK(std::fabs(r.row.pitch_px - s.pitch) < 1e-3 * 2 / 26);
  CHECK(r.row.residual_px < 1e-3);
  CHECK(std::fabs(r.angle_deg - 17) < 0.01);
  CHECK(r.row.used() == 27);
  CHECK(r.row.dark);
  // Width at half contrast: the drawn width, not changed by symmetric blur.
  CHECK(r.row.width_px == doctest::Approx(s.mark).epsilon(0.1));
  const double a = 17 * std::numbers::pi / 180;
  for (const RowMark& m : r.row.marks) {
    const Vec2 d = m.from_image - s.middle;
    const double along = d.x * std::cos(a) + d.y * std::sin(a) - s.offset;
    CHECK(std::fabs(std::remainder(along, s.pitch)) < 0.1);  // marks are 3 px wide
  }
  const RgbImage drawn = ruler_overlay(displayed(picture), r);
  CHECK(drawn.width == s.width);
  CHECK(drawn.height == s.height);
  int coloured = 0;
  for (const Rgb& p : drawn.px) coloured += p.r != p.g || p.g != p.b;
  CHECK(coloured > 27 * 10);  // at least half of the 40 px of each mark, fewer where blended
}

TEST_CASE("random rulers: never a wrong pitch, and confidence intervals with the nominal coverage") {
  // Random angle, pitch 4 to 60 px, blur, light, noise, clutter, visible part. A quarter of a per cent is far
  // below the step between integer ratios. Nominal coverage 95 %: fewer than 11 of 14 has a probability of
  // 0.4 % (binomial).
  int inside = 0, found = 0;
  for (std::uint64_t seed = 400; seed < 414; ++seed) {
    const RulerScene s = random_ruler(seed);
    CAPTURE(seed);
    CAPTURE(s.pitch);
    Ruler r;
    try {
      r = find_ruler(render(s));
    } catch (const Error& e) {
      MESSAGE(std::string(e.what()));  // a faint ruler may be refused; it counts as outside
      continue;
    }
    ++found;
    CHECK(std::fabs(r.row.pitch_px / s.pitch - 1) < 0.0025);
    // An error of a quarter of a pixel at both ends of the marks; the shortest marks are 14 px long.
    CHECK(std::fabs(std::remainder(r.angle_deg - s.angle_deg, 180)) < 57.3 * 0.5 / s.length);
    inside += std::fabs(r.row.pitch_px - s.pitch) < interval_half_width(r.row);
  }
  CHECK(found >= 13);
  CHECK(inside >= 11);
}

TEST_CASE("the finest marks are measured, not the longer ones") {
  RulerScene s;
  s.length = 16;
  s.longer = 3;  // long marks: 48 and 80 px; short ones 16
  s.pitch = 8.6;
  s.mark = 2;
  s.width = 420;
  s.height = 300;
  s.middle = {200, 140};
  for (const double angle : {0.0, 33.0, -90.0}) {
    s.angle_deg = angle;
    CHECK(pitch_of(s) == doctest::Approx(8.6).epsilon(1e-3));
  }
  s.contrast = 130;  // bright on dark
  s.ground = 40;
  CHECK(pitch_of(s) == doctest::Approx(8.6).epsilon(1e-3));
  s.mark = 5.6;  // wider than the gaps
  CHECK(pitch_of(s) == doctest::Approx(8.6).epsilon(1e-3));
  s = {};
  s.pitch = 52;  // wide marks: each with two edges
  s.mark = 24;
  s.length = 120;
  CHECK(pitch_of(s) == doctest::Approx(52).epsilon(1e-3));
}

TEST_CASE("a small part of a ruler in a large picture with text and a scale bar") {
  RulerScene s;
  s.width = 800;
  s.height = 560;
  s.middle = {500, 320};
  s.angle_deg = -23;
  s.pitch = 9.4;
  s.length = 30;
  s.first = -8;
  s.last = 8;
  s.text = 4;
  s.block = true;
  s.gradient = 0.5;
  s.noise = 6;
  CHECK(pitch_of(s) == doctest::Approx(9.4).epsilon(2e-3));
}

TEST_CASE("pictures without a ruler") {
  CHECK(message_contains(refusal(GrayF(20, 8, 3)), "too small"));
  CHECK(message_contains(refusal(GrayF(0, 0)), "too small"));
  CHECK(message_contains(refusal(GrayF(64, 48, 0)), "uniform"));
  GrayF bad(64, 48, 1);
  bad.at(3, 3) = std::numeric_limits<float>::quiet_NaN();
  CHECK(message_contains(refusal(bad), "not finite"));
  RulerScene s;
  s.first = 1;
  s.last = 0;  // no marks
  s.width = 400;
  s.height = 300;
  for (std::uint64_t seed = 1; seed < 3; ++seed) {
    s.seed = seed;
    s.noise = 12;
    s.text = 0;
    CHECK(message_contains(refusal(render(s)), "no ruler"));
    s.noise = 2;
    s.dirt = 60;
    s.gradient = 0.5;
    CHECK(message_contains(refusal(render(s)), "no ruler"));
    s.block = true;
    CHECK(message_contains(refusal(render(s)), "no ruler"));
  }
  s.dirt = 0;
  s.pitch = 30;
  s.length = 60;
  s.first = -1;  // four marks
  s.last = 2;
  CHECK(message_contains(refusal(render(s)), "no ruler"));
  DropScene drop;
  drop.width = 420;
  drop.height = 310;
  drop.centre = {200, 160};
  drop.radius = 120;
  drop.step = 40;
  drop.cells = 100;
  CHECK(message_contains(refusal(render(drop)), "no ruler"));
}

TEST_CASE("two scales without integer ratio are refused") {
  RulerScene s;
  s.noise = 2;
  s.pitch = 10;
  s.longer = 1;
  s.length = 60;
  s.middle = {348, 120};
  GrayF mm = render(s);
  s.pitch = 15.9;  // 1/16 inch marks beside millimetre marks
  s.middle = {348, 400};
  const GrayF inches = render(s);
  for (std::size_t i = 0; i < mm.px.size(); ++i) mm.px[i] = std::min(mm.px[i], inches.px[i]);
  CHECK(message_contains(refusal(mm), "two scales"));
}

TEST_CASE("the result is reproducible bit for bit") {
  const GrayF picture = render(random_ruler(3));
  const Ruler a = find_ruler(picture), b = find_ruler(picture);
  CHECK(a.row.pitch_px == b.row.pitch_px);
  CHECK(a.row.se_pitch_px == b.row.se_pitch_px);
}
