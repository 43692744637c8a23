#include "study/motion/displacement_sums.h"

#include <algorithm>
#include <cmath>

#include "vision/cells/spot_fit.h"
#include "vision/image/kernels/smoothing.h"

namespace faba {
namespace {

// Of the surround, which is subtracted, over the size of an object. A narrow one would be reduced by the
// neighbours in a row of objects, so that they counted less than single ones.
constexpr double kSurroundRatio = 14;
constexpr double kThresholdSd = 1.5, kObjectSd = 4;  // of the noise of the smoothed picture

// Samples of an object across its width, at least: the smoothed picture has no finer details.
constexpr double kSamplesAcross = 2.4;

/// A displacement along a direction and across it, px.
struct Turned {
  double along = 0, across = 0;
};

Turned turned(int dx, int dy, Vec2 along) {
  return {dx * along.x + dy * along.y, dy * along.x - dx * along.y};
}

// Whether a displacement counts in a profile, which interpolates between two of its values.
bool counts(Turned d, double half_width) {
  return std::fabs(d.along) <= kLongestShift - 1 && std::fabs(d.across) <= half_width;
}

}  // namespace

ObjectPicture object_picture(const GrayF& objects, double size_px, double noise) {
  ObjectPicture p;
  const double sd = size_px / kFwhmPerSd;
  p.light = smoothed(objects, sd);
  const GrayF wide = smoothed(objects, kSurroundRatio * sd);
  const double noise_sd = noise / std::sqrt(4 * M_PI * sd * sd);
  const auto least = float(kThresholdSd * noise_sd), of_objects = float(kObjectSd * noise_sd);
  const int every = std::max(1, int(size_px / kSamplesAcross));
  for (int r = 0; r < p.light.height; ++r)
    for (int c = 0; c < p.light.width; ++c) {
      const std::size_t i = std::size_t(r) * std::size_t(p.light.width) + std::size_t(c);
      const float v = p.light.px[i] - wide.px[i];
      p.light.px[i] = std::fabs(v) > least ? v : 0.0F;
      if (v > of_objects && r % every == 0 && c % every == 0) p.pixels.push_back({c, r, 1});
    }
  return p;
}

void DisplacementSums::add(const DisplacementSums& o, double factor) {
  for (std::size_t i = 0; i < sums_.size(); ++i) sums_[i] += factor * o.sums_[i];
}

ShiftProfile DisplacementSums::profile(const ShiftWindow& window) const {
  ShiftProfile profile{};
  for (int dy = -kLongestShift; dy <= kLongestShift; ++dy)
    for (int dx = -kLongestShift; dx <= kLongestShift; ++dx) {
      const Turned d = turned(dx, dy, window.along);
      if (!counts(d, window.half_width)) continue;
      const double s = d.along + kLongestShift, low = std::floor(s);
      profile[std::size_t(low)] += (low + 1 - s) * at(dx, dy);
      if (s > low) profile[std::size_t(low) + 1] += (s - low) * at(dx, dy);
    }
  return profile;
}

double DisplacementSums::across(const ShiftWindow& window, double from, double to) const {
  double sum = 0, moment = 0;
  for (int dy = -kLongestShift; dy <= kLongestShift; ++dy)
    for (int dx = -kLongestShift; dx <= kLongestShift; ++dx) {
      const Turned d = turned(dx, dy, window.along);
      if (!counts(d, window.half_width) || d.along < from || d.along > to) continue;
      const double difference = std::max(at(dx, dy) - at(-dx, -dy), 0.0);
      sum += difference;
      moment += difference * d.across;
    }
  return sum > 0 ? moment / sum : 0;
}

PictureCorrelator::PictureCorrelator(const ShiftWindow& window) : window_(window) {
  for (int dy = -kLongestShift; dy <= kLongestShift; ++dy)
    for (int dx = -kLongestShift; dx <= kLongestShift; ++dx)
      if (inside(dx, dy)) compared_.include(dx, dy);
}

bool PictureCorrelator::inside(int dx, int dy) const {
  const Turned d = turned(dx, dy, window_.along);
  return counts(d, window_.half_width + kMostTurn * std::fabs(d.along));
}

DisplacementSums PictureCorrelator::between(const ObjectPicture& a, const ObjectPicture& b) const {
  const CorrelationSums forward = compared_.sums(a.pixels, b.light);
  if (&a == &b) return mean_of_both(forward, forward);
  return mean_of_both(forward, compared_.sums(b.pixels, a.light));
}

// The second sums are those of the way back.
DisplacementSums PictureCorrelator::mean_of_both(const CorrelationSums& forward,
                                                 const CorrelationSums& backward) const {
  DisplacementSums mean;
  for (int dy = -kLongestShift; dy <= kLongestShift; ++dy)
    for (int dx = -kLongestShift; dx <= kLongestShift; ++dx)
      if (inside(dx, dy))
        mean.sums_[DisplacementSums::index(dx, dy)] =
            0.5 * (double(forward.at(dx, dy)) + double(backward.at(-dx, -dy)));
  return mean;
}

}  // namespace faba
