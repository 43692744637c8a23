#pragma once
// Pictures of cells with known positions, for tests of detection, tracking and image estimators.

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <vector>

#include "core/random/philox.h"
#include "core/vec.h"
#include "vision/image/image.h"

namespace faba::cells {

/// Counter-based random numbers of a test: normal and uniform.
class Dice {
 public:
  explicit Dice(std::uint64_t seed) : seed_(seed) {}
  double uniform() {
    const auto w = draw(seed_, Stream::camera, count_++, 0);
    return double(faba::uniform(w[0]));
  }
  double normal() {
    const auto w = draw(seed_, Stream::camera, count_++, 1);
    return double(normals(w[0], w[1])[0]);
  }

 private:
  std::uint64_t seed_;
  std::uint32_t count_ = 0;
};

/// Parameters of the pictures. Grey values of 8 bits.
struct Look {
  int width = 320, height = 240;
  /// Background grey, and grey change at the centre of a cell. Dark cells absorb a fraction of the light,
  /// bright cells add light.
  double level = 150, amplitude = -60;
  double cell_sd_px = 1.27;  ///< full width at half maximum 3 px
  double noise = 2;          ///< sd
  double light = 1;          ///< factor on the light, without the noise
  bool uneven = true;        ///< vignetting and a gradient
  bool drop = false;         ///< drop edge: an arc of 25 degrees over the height, at the left
};

/// Circle with an arc of 25 degrees that crosses the picture from top to bottom, at x = 60 at half height.
struct Arc {
  Vec2 centre;
  double radius;
};
inline Arc arc_of(const Look& l) {
  const double radius = 0.5 * l.height / std::sin(12.5 * 3.14159265358979 / 180);
  return {{60 + radius, 0.5 * (l.height - 1)}, radius};
}

inline double ground(const Look& l, double x, double y) {
  double v = l.level;
  if (l.uneven) {
    const double u = (x - 0.5 * l.width) / l.width, w = (y - 0.5 * l.height) / l.height;
    v *= 1 - 0.35 * (u * u + w * w) + 0.12 * u;
  }
  if (l.drop) {
    const Arc a = arc_of(l);
    const double depth = a.radius - std::hypot(x - a.centre.x, y - a.centre.y);
    v += 12 / (1 + std::exp(-depth / 1.5)) - 45 * std::exp(-0.5 * depth * depth / 4);
  }
  return v;
}

/// One picture; `seed`: seed of the noise; `scale`: factors on sigma and amplitude of single cells.
inline GrayF picture(const Look& l, const std::vector<Vec2>& cells, std::uint64_t seed) {
  GrayF out(l.width, l.height);
  const int reach = int(std::ceil(5 * l.cell_sd_px));
  for (const Vec2 c : cells)
    for (int row = std::max(0, int(c.y) - reach); row <= std::min(l.height - 1, int(c.y) + reach); ++row)
      for (int col = std::max(0, int(c.x) - reach); col <= std::min(l.width - 1, int(c.x) + reach); ++col) {
        const double r2 = (col - c.x) * (col - c.x) + (row - c.y) * (row - c.y);
        out.at(col, row) += float(l.amplitude * std::exp(-0.5 * r2 / (l.cell_sd_px * l.cell_sd_px)));
      }
  for (int row = 0; row < l.height; ++row)
    for (int col = 0; col < l.width; ++col) {
      const double light = ground(l, col, row), sum = double(out.at(col, row));
      out.at(col, row) = float(l.amplitude < 0 ? light * std::exp(sum / l.level) : light + sum);
    }
  for (std::size_t i = 0; i < out.px.size(); i += 2) {
    const auto w = draw(seed, Stream::camera, std::uint32_t(i), 7);
    const auto n = normals(w[0], w[1]);
    for (std::size_t k = 0; k < 2 && i + k < out.px.size(); ++k) {
      const double v = l.light * double(out.px[i + k]) + l.noise * double(n[k]);
      out.px[i + k] = float(std::clamp(std::floor(v + 0.5), 0.0, 255.0));
    }
  }
  return out;
}

inline Gray8 bytes(const GrayF& g) {
  Gray8 out(g.width, g.height);
  std::transform(g.px.begin(), g.px.end(), out.px.begin(), [](float v) { return std::uint8_t(v); });
  return out;
}

/// Random positions with at least `apart` px distance and `margin` px from the border.
inline std::vector<Vec2> scattered(const Look& l, int n, double apart, double margin, std::uint64_t seed) {
  Dice dice(seed);
  std::vector<Vec2> out;
  for (int tries = 0; int(out.size()) < n && tries < 2000 * n; ++tries) {
    const Vec2 p{margin + dice.uniform() * (l.width - 1 - 2 * margin),
                 margin + dice.uniform() * (l.height - 1 - 2 * margin)};
    if (std::all_of(out.begin(), out.end(), [&](Vec2 q) { return norm(p - q) >= apart; })) out.push_back(p);
  }
  return out;
}

/// A swarm at the edge of the drop: Gaussian along the arc with an sd of `along` px, exponential in depth
/// beyond `gap`.
inline std::vector<Vec2> at_the_edge(const Look& l, int n, double along, double depth, double gap,
                                     std::uint64_t seed) {
  Dice dice(seed);
  const Arc a = arc_of(l);
  std::vector<Vec2> out;
  while (int(out.size()) < n) {
    const double angle = along * dice.normal() / a.radius, in = gap - depth * std::log(dice.uniform());
    const Vec2 p{a.centre.x - (a.radius - in) * std::cos(angle),
                 a.centre.y + (a.radius - in) * std::sin(angle)};
    if (p.x > 2 && p.y > 2 && p.x < l.width - 3 && p.y < l.height - 3) out.push_back(p);
  }
  return out;
}

struct Spread {
  Vec2 centroid;
  Mat2 cov;
};
inline Spread spread(const std::vector<Vec2>& p) {
  Spread s;
  const double n = double(p.size());
  for (const Vec2 v : p) s.centroid = s.centroid + 1 / n * v;
  for (const Vec2 v : p) {
    const Vec2 d = v - s.centroid;
    s.cov.xx += d.x * d.x / n;
    s.cov.xy += d.x * d.y / n;
    s.cov.yy += d.y * d.y / n;
  }
  return s;
}

}  // namespace faba::cells
