#include "vision/foreground/kernels/line_closing.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <limits>
#include <utility>
#include <vector>

#include "core/vectorised.h"

namespace faba {
namespace {

constexpr int kDirections = 24;

// cos and sin of i * 180 / 24 degrees: constants, because results of the C library differ between machines.
constexpr std::array<std::array<double, 2>, kDirections> kAxes{{{1, 0},
                                                                {0.9914448614, 0.1305261922},
                                                                {0.9659258263, 0.2588190451},
                                                                {0.9238795325, 0.3826834324},
                                                                {0.8660254038, 0.5},
                                                                {0.7933533403, 0.608761429},
                                                                {0.7071067812, 0.7071067812},
                                                                {0.608761429, 0.7933533403},
                                                                {0.5, 0.8660254038},
                                                                {0.3826834324, 0.9238795325},
                                                                {0.2588190451, 0.9659258263},
                                                                {0.1305261922, 0.9914448614},
                                                                {0, 1},
                                                                {-0.1305261922, 0.9914448614},
                                                                {-0.2588190451, 0.9659258263},
                                                                {-0.3826834324, 0.9238795325},
                                                                {-0.5, 0.8660254038},
                                                                {-0.608761429, 0.7933533403},
                                                                {-0.7071067812, 0.7071067812},
                                                                {-0.7933533403, 0.608761429},
                                                                {-0.8660254038, 0.5},
                                                                {-0.9238795325, 0.3826834324},
                                                                {-0.9659258263, 0.2588190451},
                                                                {-0.9914448614, 0.1305261922}}};

FABA_VECTORISED void take_larger(float* out, const float* in, int n) {
  FABA_ELEMENTWISE
  for (int i = 0; i < n; ++i) out[i] = out[i] > in[i] ? out[i] : in[i];
}
FABA_VECTORISED void take_smaller(float* out, const float* in, int n) {
  FABA_ELEMENTWISE
  for (int i = 0; i < n; ++i) out[i] = out[i] < in[i] ? out[i] : in[i];
}

struct Step {
  int col, row;
};

// Segments of 2 half + 1 px, each a parabola that is `bend` k^2 beside its axis at a distance of k.
std::vector<std::vector<Step>> segments(int half, double bend) {
  const bool straight = bend * half * half < 0.5;
  std::vector<std::vector<Step>> all;
  for (const auto& axis : kAxes)
    for (const double side : {1.0, -1.0}) {
      if (straight && side < 0) continue;
      std::vector<Step> segment;
      for (int k = -half; k <= half; ++k) {
        const double beside = straight ? 0 : side * bend * k * k;
        segment.push_back({int(std::floor(k * axis[0] - beside * axis[1] + 0.5)),
                           int(std::floor(k * axis[1] + beside * axis[0] + 0.5))});
      }
      all.push_back(std::move(segment));
    }
  return all;
}

std::vector<Step> reversed(std::vector<Step> segment) {
  for (Step& s : segment) s = {-s.col, -s.row};
  return segment;
}

// out = maximum (or minimum) of the picture along the segment; pixels beyond the border are ignored.
void extremum_along(const GrayF& g, const std::vector<Step>& segment, bool largest, GrayF& out) {
  out.px.assign(g.px.size(), (largest ? -1 : 1) * std::numeric_limits<float>::max());
  for (const Step s : segment)
    for (int row = std::max(0, -s.row); row < std::min(g.height, g.height - s.row); ++row) {
      const int first = std::max(0, -s.col), n = std::min(g.width, g.width - s.col) - first;
      if (n <= 0) continue;
      float* to = &out.px[std::size_t(row) * std::size_t(g.width) + std::size_t(first)];
      const float* from = &g.px[std::size_t(row + s.row) * std::size_t(g.width) + std::size_t(first + s.col)];
      largest ? take_larger(to, from, n) : take_smaller(to, from, n);
    }
}

LineClosing empty_closing(const GrayF& picture) {
  constexpr float kMost = std::numeric_limits<float>::max();
  return {GrayF(picture.width, picture.height, kMost), GrayF(picture.width, picture.height, -kMost)};
}

void add(LineClosing& all, const GrayF& least, const GrayF& largest) {
  take_smaller(all.least.px.data(), least.px.data(), int(least.px.size()));
  take_larger(all.largest.px.data(), largest.px.data(), int(largest.px.size()));
}

}  // namespace

LineClosing line_closing(const GrayF& picture, double length_px, Pool& pool, double radius_px) {
  const int half = std::max(1, int(length_px / 2));
  const std::vector<std::vector<Step>> all = segments(half, 0.5 / radius_px);
  std::vector<LineClosing> parts(pool.threads());
  pool.run(parts.size(), [&](std::size_t part) {
    parts[part] = empty_closing(picture);
    GrayF work(picture.width, picture.height), closed(picture.width, picture.height);
    for (std::size_t i = part; i < all.size(); i += parts.size()) {
      extremum_along(picture, all[i], true, work);
      extremum_along(work, reversed(all[i]), false, closed);
      add(parts[part], closed, closed);
    }
  });
  for (std::size_t part = 1; part < parts.size(); ++part)
    add(parts.front(), parts[part].least, parts[part].largest);
  return std::move(parts.front());
}

}  // namespace faba
