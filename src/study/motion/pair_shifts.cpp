#include "study/motion/pair_shifts.h"

#include <algorithm>
#include <cmath>
#include <optional>

#include "vision/cells/spot_fit.h"
#include "vision/image/kernels/arithmetic.h"
#include "vision/image/kernels/smoothing.h"

namespace faba {
namespace {

constexpr double kSurround = 12;  // px: sd of the smoothed copy that the band pass subtracts
constexpr std::array kRegistrationScales{4.0, 18.0};  // px
constexpr double kForegroundSd = 4;                   // standard deviations of the smoothed noise

/// What the measures need of one picture.
struct ShiftPicture {
  double t_s = 0, mass = 0;
  Vec2 centroid;
  GrayF band;
  std::array<GrayF, kRegistrationScales.size()> smooth;
};

ShiftPicture shift_picture(const GrayF& objects, double t_s, double size_px, double noise) {
  ShiftPicture p;
  p.t_s = t_s;
  const double sd = size_px / kFwhmPerSd;
  p.band = smoothed(objects, sd);
  subtract(p.band, smoothed(p.band, kSurround));
  // Variance of white noise after smoothing with a Gaussian: 1 / (4 pi sd^2).
  const auto least = float(kForegroundSd * noise / std::sqrt(4 * M_PI * sd * sd));
  for (int r = 0; r < p.band.height; ++r)
    for (int c = 0; c < p.band.width; ++c)
      if (const float v = p.band.at(c, r); v > least) {
        p.mass += double(v);
        p.centroid = p.centroid + double(v) * Vec2{double(c), double(r)};
      }
  if (p.mass > 0) p.centroid = (1 / p.mass) * p.centroid;
  for (std::size_t s = 0; s < kRegistrationScales.size(); ++s)
    p.smooth[s] = smoothed(p.band, kRegistrationScales[s]);
  return p;
}

// Sum over the inner pixels of `weights` times the gradient (central differences) of `picture`.
Vec2 weighted_gradient(const GrayF& weights, const GrayF& picture) {
  Vec2 sum;
  for (int r = 1; r + 1 < picture.height; ++r)
    for (int c = 1; c + 1 < picture.width; ++c) {
      const auto w = double(weights.at(c, r));
      sum.x += w * double(picture.at(c + 1, r) - picture.at(c - 1, r));
      sum.y += w * double(picture.at(c, r + 1) - picture.at(c, r - 1));
    }
  return 0.5 * sum;
}

// Sum of the scalar product of both gradients, per axis.
double gradient_energy(const GrayF& a, const GrayF& b) {
  double sum = 0;
  for (int r = 1; r + 1 < a.height; ++r)
    for (int c = 1; c + 1 < a.width; ++c) {
      sum += double(a.at(c + 1, r) - a.at(c - 1, r)) * double(b.at(c + 1, r) - b.at(c - 1, r));
      sum += double(a.at(c, r + 1) - a.at(c, r - 1)) * double(b.at(c, r + 1) - b.at(c, r - 1));
    }
  return sum / 8;
}

}  // namespace

const char* word_of(ShiftMeasure measure) {
  switch (measure) {
    case ShiftMeasure::centroid:
      return "centroid";
    case ShiftMeasure::fine:
      return "registration, 4 px";
    case ShiftMeasure::coarse:
      return "registration, 18 px";
  }
  return "";
}

PairShifts pair_shifts(const ResponseFrames& frames, const VideoPart& part) {
  PairShifts shifts;
  std::optional<ShiftPicture> before;
  std::vector<ShiftPicture> pictures(frames.slots());
  const auto work = [&](std::size_t slot, const GrayF& objects, double t_s) {
    pictures[slot] = shift_picture(objects, t_s, frames.object_px(), frames.noise());
  };
  frames.each(part, work, [&](std::size_t slot) {
    ShiftPicture& now = pictures[slot];
    if (before) {
      shifts.t0_s.push_back(before->t_s);
      shifts.t1_s.push_back(now.t_s);
      const bool seen = before->mass > 0 && now.mass > 0;
      const double side = frames.side();
      shifts.by[0].push_back(seen ? side * (now.centroid - before->centroid) : Vec2{});
      for (std::size_t s = 0; s < kRegistrationScales.size(); ++s) {
        const double energy =
            gradient_energy(before->band, before->smooth[s]) + gradient_energy(now.band, now.smooth[s]);
        const Vec2 moved =
            weighted_gradient(before->band, now.smooth[s]) - weighted_gradient(now.band, before->smooth[s]);
        shifts.by[s + 1].push_back(energy > 0 ? (side / energy) * moved : Vec2{});
      }
    }
    before = std::move(now);
  });
  return shifts;
}

}  // namespace faba
