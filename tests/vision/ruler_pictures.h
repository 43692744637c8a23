#pragma once
#include <algorithm>
#include <cmath>
#include <cstdint>
#include <numbers>

#include "tests/vision/drop_pictures.h"

namespace faba {

/// A synthetic microscope picture of a ruler. Frame of the ruler: s along it, t along its marks, px, zero at
/// `middle`.
struct RulerScene {
  int width = 696, height = 520;
  Vec2 middle{340, 250};           ///< centre of the ruler in the picture
  double angle_deg = 0;            ///< direction of the ruler, from x towards y
  double pitch = 12.3;             ///< px
  double offset = 0.3;             ///< position of mark 0, px
  int first = -1000, last = 1000;  ///< indices of the first and last mark
  double mark = 3;                 ///< width, px
  double length = 40;              ///< length of the short marks, px
  double longer = 1.5;     ///< length factor of every fifth mark; every tenth has twice the extra length
  bool baseline = false;   ///< a line along the foot of the marks
  bool two_sided = false;  ///< longer marks extend on both sides
  double contrast = -120;  ///< grey of a mark minus background
  double ground = 190, gradient = 0;  ///< grey; fraction of the light lost from one side to the other
  double blur = 1;                    ///< px, Gaussian sd
  double noise = 2;                   ///< grey, sd
  int text = 0;                       ///< number of text lines
  bool block = false;                 ///< a scale bar
  int dirt = 0;                       ///< number of round spots
  int bits = 8;
  std::uint64_t seed = 1;
};

/// A bar of width `size` about 0, blurred: 1 inside, 0 outside.
inline double blurred_bar(double distance, double size, double blur) {
  const double unit = blur * std::numbers::sqrt2;
  return 0.5 * (std::erf((distance + size / 2) / unit) - std::erf((distance - size / 2) / unit));
}

/// Fraction of ink at a point of the ruler frame.
inline double ruler_ink(const RulerScene& s, double along, double across) {
  const double nearest = std::round((along - s.offset) / s.pitch);
  double ink = 0;
  for (double k = nearest - 1; k <= nearest + 1; ++k) {
    if (k < s.first || k > s.last) continue;
    const int index = int(k);
    const double times = index % 10 == 0 ? 1 + 2 * (s.longer - 1) : index % 5 == 0 ? s.longer : 1;
    // The foot of the marks is at -length / 2 unless the longer marks extend on both sides.
    const double extra = s.length * (times - 1), middle = s.two_sided ? 0 : extra / 2;
    const double size = s.two_sided ? s.length + 2 * extra : s.length + extra;
    ink += blurred_bar(along - s.offset - k * s.pitch, s.mark, s.blur) *
           blurred_bar(across - middle, size, s.blur);
  }
  if (s.baseline) {
    const double begin = s.offset + s.first * s.pitch, end = s.offset + s.last * s.pitch;
    ink = std::max(ink, blurred_bar(across + s.length / 2, s.mark, s.blur) *
                            blurred_bar(along - (begin + end) / 2, end - begin, s.blur));
  }
  return std::min(1.0, ink);
}

inline void add_stroke(GrayF& im, Vec2 a, Vec2 b, double size, double grey) {
  const Vec2 d = b - a;
  const double length = std::max(1e-6, norm(d));
  const int reach = int(size) + 2;
  for (int r = std::max(0, int(std::min(a.y, b.y)) - reach);
       r <= std::min(im.height - 1, int(std::max(a.y, b.y)) + reach); ++r)
    for (int c = std::max(0, int(std::min(a.x, b.x)) - reach);
         c <= std::min(im.width - 1, int(std::max(a.x, b.x)) + reach); ++c) {
      const Vec2 p = Vec2{double(c), double(r)} - a;
      const double along = std::clamp(dot(p, d) / (length * length), 0.0, 1.0);
      const double off = norm(p - along * d);
      if (off < size / 2 + 0.5) im.at(c, r) = float(grey);
    }
}

/// Lines of letter-like strokes at a fixed advance, as in printed text.
inline void add_text(GrayF& im, int lines, double grey, FrameNoise& noise) {
  for (int line = 0; line < lines; ++line) {
    const double size = 10 + 14 * noise.uniform(), advance = 0.62 * size;
    const Vec2 at{noise.uniform() * im.width * 0.6, size + noise.uniform() * (im.height - 2 * size)};
    const int letters = 8 + int(noise.uniform() * 16);
    for (int k = 0; k < letters; ++k)
      for (int stroke = 0; stroke < 3; ++stroke) {
        const double x = at.x + k * advance;
        const bool upright = noise.uniform() < 0.5;
        const Vec2 a{x + (upright ? std::floor(noise.uniform() * 2) : 0) * 0.45 * size, at.y};
        const Vec2 b = upright ? Vec2{a.x, a.y - size * 0.7}
                               : Vec2{x + 0.45 * size, a.y - size * 0.35 * std::floor(noise.uniform() * 3)};
        add_stroke(im, a, b, size / 9, grey);
      }
  }
}

inline GrayF render(const RulerScene& s) {
  GrayF im(s.width, s.height);
  FrameNoise noise(s.seed);
  const double a = s.angle_deg * std::numbers::pi / 180;
  const Vec2 u{std::cos(a), std::sin(a)}, v{-std::sin(a), std::cos(a)};
  for (int r = 0; r < s.height; ++r)
    for (int c = 0; c < s.width; ++c) {
      const Vec2 p = Vec2{double(c), double(r)} - s.middle;
      im.at(c, r) = float(s.ground + s.contrast * ruler_ink(s, dot(p, u), dot(p, v)));
    }
  const double ink = s.ground + s.contrast;
  add_text(im, s.text, ink, noise);
  if (s.block) {
    const Vec2 at{noise.uniform() * s.width * 0.7, noise.uniform() * s.height * 0.9};
    add_stroke(im, at, at + Vec2{0.25 * s.width, 0}, 24, ink);
  }
  for (int k = 0; k < s.dirt; ++k)
    add_cell(im, {noise.uniform() * s.width, noise.uniform() * s.height}, s.contrast,
             1 + 2 * noise.uniform());
  const double gx = std::cos(double(s.seed)), gy = std::sin(double(s.seed));
  const double top = s.bits == 8 ? 255 : 65535, gain = s.bits == 8 ? 1 : 16;
  for (int r = 0; r < s.height; ++r)
    for (int c = 0; c < s.width; ++c) {
      const double place = 0.5 + 0.5 * (gx * (2.0 * c / s.width - 1) + gy * (2.0 * r / s.height - 1)) / 1.42;
      const double grey = double(im.at(c, r)) * (1 - s.gradient * place) + s.noise * noise.gauss();
      im.at(c, r) = float(std::clamp(std::round(grey * gain), 0.0, top));
    }
  return im;
}

/// A ruler with random parameters: angle, pitch 4 to 60 px, blur, light, noise, clutter, visible part.
inline RulerScene random_ruler(std::uint64_t seed) {
  FrameNoise random(seed * 7919 + 17);
  const auto from = [&](double low, double high) { return low + (high - low) * random.uniform(); };
  RulerScene s;
  s.width = 560;
  s.height = 420;
  s.seed = seed;
  s.angle_deg = from(-90, 90);
  s.pitch = 4 * std::pow(15.0, random.uniform());
  s.offset = from(0, s.pitch);
  s.mark = std::max(1.2, from(0.12, 0.5) * s.pitch);
  s.length = std::max(14.0, from(1.5, 6) * s.pitch);
  s.longer = from(1, 2);
  s.baseline = random.uniform() < 0.5;
  s.two_sided = random.uniform() < 0.3;
  s.blur = std::min(from(0.5, 2.5), 0.28 * s.pitch);
  s.noise = from(0, 15);
  s.contrast = from(60, 150) * (random.uniform() < 0.6 ? -1 : 1);
  s.ground = s.contrast < 0 ? from(170, 230) : from(20, 70);
  s.gradient = from(0, 0.6);
  s.text = int(from(0, 5));
  s.block = random.uniform() < 0.4;
  s.dirt = int(from(0, 40));
  s.middle = {s.width * from(0.35, 0.65), s.height * from(0.35, 0.65)};
  if (random.uniform() < 0.5) {
    const int half = std::max(6, int(from(0.12, 0.4) * s.width / s.pitch));
    s.first = -half;
    s.last = half;
  }
  s.bits = random.uniform() < 0.3 ? 16 : 8;
  return s;
}

}  // namespace faba
