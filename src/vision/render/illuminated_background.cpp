#include "vision/render/illuminated_background.h"

#include <algorithm>
#include <cmath>
#include <vector>

#include "core/portable_math.h"
#include "core/random/draw_blocks.h"

namespace faba {
namespace {

constexpr int kWaves = 6;
constexpr double kEdgeReach = 7;  // widths; the edge is below 1e-10 beyond

struct Wave {
  double x, y, phase;  // rad per px, rad
};

// Wavelengths between one and two times the longer side of the picture.
std::vector<Wave> waves_of(const Frame& frame, std::uint64_t seed) {
  std::vector<Wave> waves;
  const double side = std::max(frame.width, frame.height);
  for (std::uint32_t i = 0; i < kWaves; ++i) {
    const auto word = draw(seed, kWaveDraws, i, 0);
    const double wavenumber = 2 * portable::kPi / (side * (1 + double(uniform(word[0]))));
    const auto direction = portable::sincos(2 * portable::kPi * double(uniform(word[1])));
    waves.push_back({wavenumber * direction.cos, wavenumber * direction.sin,
                     2 * portable::kPi * double(uniform(word[2]))});
  }
  return waves;
}

void add_waves(double rms, const std::vector<Wave>& waves, GrayF& ground) {
  const double amplitude = rms * std::sqrt(2.0 / double(waves.size()));
  std::vector<portable::SinCosD> across(std::size_t(ground.width));
  GrayF sum(ground.width, ground.height, 1.0F);
  for (const Wave& w : waves) {
    for (int c = 0; c < ground.width; ++c) across[std::size_t(c)] = portable::sincos(w.x * c + w.phase);
    for (int r = 0; r < ground.height; ++r) {
      const auto down = portable::sincos(w.y * r);
      for (int c = 0; c < ground.width; ++c) {
        const auto& a = across[std::size_t(c)];
        sum.at(c, r) += float(amplitude * (a.cos * down.cos - a.sin * down.sin));
      }
    }
  }
  for (std::size_t i = 0; i < ground.px.size(); ++i) ground.px[i] *= sum.px[i];
}

void add_edge(const MicroscopeParams& p, double m_per_px, const Circle& edge, GrayF& ground) {
  const double w = std::max(std::sqrt(p.edge_width * p.edge_width + p.psf_sd * p.psf_sd) / m_per_px, 0.05);
  for (int r = 0; r < ground.height; ++r)
    for (int c = 0; c < ground.width; ++c) {
      const double t = (norm(Vec2{double(c), double(r)} - edge.centre) - edge.radius) / w;
      if (t < -kEdgeReach) continue;
      const double outside_fraction = t > kEdgeReach ? 1 : portable::normal_cdf(t);
      double factor = 1 + (p.outside_level - 1) * outside_fraction;
      if (t < kEdgeReach) factor *= 1 + p.edge_contrast * portable::exp(-0.5 * t * t);
      ground.at(c, r) *= float(factor);
    }
}

}  // namespace

GrayF illuminated_background(const MicroscopeParams& p, const Frame& frame, const Circle& edge,
                             std::uint64_t seed) {
  GrayF ground(frame.width, frame.height);
  const Vec2 middle{(frame.width - 1) / 2.0, (frame.height - 1) / 2.0};
  const double corner = std::max(dot(middle, middle), 1e-9);
  for (int r = 0; r < frame.height; ++r)
    for (int c = 0; c < frame.width; ++c) {
      const Vec2 d = Vec2{double(c), double(r)} - middle;
      ground.at(c, r) = float(p.level * (1 - p.vignetting * dot(d, d) / corner));
    }
  if (p.unevenness > 0) add_waves(p.unevenness, waves_of(frame, seed), ground);
  if (edge.radius > 0) add_edge(p, frame.m_per_px, edge, ground);
  return ground;
}

}  // namespace faba
