#pragma once
#include <algorithm>
#include <cmath>
#include <cstdint>
#include <numbers>
#include <vector>

#include "core/vec.h"
#include "vision/image/image.h"

namespace faba {

/// Random numbers for rendered frames: reproducible on every machine, unlike those of <random>.
class FrameNoise {
 public:
  /// The seed constant differs from the step constant; otherwise neighbouring seeds would share numbers.
  explicit FrameNoise(std::uint64_t seed) : state_((seed + 1) * 0xd1342543de82ef95ULL) {}
  double uniform() {
    std::uint64_t z = (state_ += 0x9e3779b97f4a7c15ULL);
    z = (z ^ (z >> 30)) * 0xbf58476d1ce4e5b9ULL;
    z = (z ^ (z >> 27)) * 0x94d049bb133111ebULL;
    return (double((z ^ (z >> 31)) >> 11) + 0.5) / 9007199254740992.0;
  }
  double gauss() { return std::sqrt(-2 * std::log(uniform())) * std::cos(2 * std::numbers::pi * uniform()); }

 private:
  std::uint64_t state_;
};

/// A synthetic microscope frame, not square.
struct DropScene {
  int width = 640, height = 480;
  Vec2 centre{320, 240};
  double radius = 0;           ///< px; 0: no drop
  double step = 0;             ///< grey inside minus outside
  double ring = 0;             ///< grey of a line along the edge, negative: dark
  double blur = 1.5;           ///< px, Gaussian sd of the step and of the line
  double ground = 120;         ///< background grey
  double vignette = 0;         ///< fraction of the light lost in the corners
  double noise = 3;            ///< grey, sd
  int cells = 0;               ///< number of small spots, inside the drop if there is one
  bool cells_outside = false;  ///< spots outside the drop instead
  double cell_grey = -40;
  int hot_pixels = 0;
  int bits = 8;
  double gain = 1;  ///< counts per grey
  std::uint64_t seed = 1;
};

inline void add_cell(GrayF& im, Vec2 at, double grey, double size) {
  const int reach = int(4 * size) + 1;
  for (int r = std::max(0, int(at.y) - reach); r <= std::min(im.height - 1, int(at.y) + reach); ++r)
    for (int c = std::max(0, int(at.x) - reach); c <= std::min(im.width - 1, int(at.x) + reach); ++c) {
      const Vec2 d = Vec2{double(c), double(r)} - at;
      im.at(c, r) += float(grey * std::exp(-0.5 * dot(d, d) / (size * size)));
    }
}

inline GrayF render(const DropScene& s) {
  GrayF im(s.width, s.height);
  FrameNoise noise(s.seed);
  const Vec2 middle{(s.width - 1) / 2.0, (s.height - 1) / 2.0};
  for (int r = 0; r < s.height; ++r)
    for (int c = 0; c < s.width; ++c) {
      const Vec2 p{double(c), double(r)};
      double grey = s.ground;
      if (s.radius > 0) {
        const double t = (norm(p - s.centre) - s.radius) / s.blur;
        grey += s.step * 0.5 * std::erfc(t / std::numbers::sqrt2) + s.ring * std::exp(-0.5 * t * t);
      }
      im.at(c, r) = float(grey * (1 - s.vignette * dot(p - middle, p - middle) / dot(middle, middle)));
    }
  for (int k = 0; k < s.cells;) {
    const Vec2 at{noise.uniform() * s.width, noise.uniform() * s.height};
    const double depth = s.radius - norm(at - s.centre);
    if (s.radius > 0 && (s.cells_outside ? depth > -6 : depth < 3)) continue;
    add_cell(im, at, s.cell_grey * (0.5 + noise.uniform()), 1.5 + 1.5 * noise.uniform());
    ++k;
  }
  const double top = s.bits == 8 ? 255 : 65535;
  for (float& p : im.px)
    p = float(std::clamp(std::round((double(p) + s.noise * noise.gauss()) * s.gain), 0.0, top));
  for (int k = 0; k < s.hot_pixels; ++k)
    im.px[std::size_t(noise.uniform() * double(im.px.size()))] = float(top);
  return im;
}

/// Centre of a circle of the given radius whose edge crosses the frame at `at`, with the centre in the
/// direction `toward_deg` (0 right, 90 down).
inline Vec2 centre_for(Vec2 at, double radius, double toward_deg) {
  const double a = toward_deg * std::numbers::pi / 180;
  return {at.x + radius * std::cos(a), at.y + radius * std::sin(a)};
}

/// Maximum distance between two circles along the visible part of the first.
inline double arc_distance(const DropScene& s, Vec2 centre, double radius) {
  double most = 0;
  for (int i = 0; i < 7200; ++i) {
    const double a = i * std::numbers::pi / 3600;
    const Vec2 p{s.centre.x + s.radius * std::cos(a), s.centre.y + s.radius * std::sin(a)};
    if (p.x < 0 || p.y < 0 || p.x > s.width - 1 || p.y > s.height - 1) continue;
    most = std::max(most, std::fabs(norm(p - centre) - radius));
  }
  return most;
}

}  // namespace faba
