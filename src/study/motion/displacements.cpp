#include "study/motion/displacements.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "core/random/distributions.h"
#include "core/threads/parallel.h"
#include "core/units.h"
#include "core/vec.h"
#include "study/motion/kernels/correlation_window.h"
#include "study/stats/study_random.h"
#include "vision/cells/spot_fit.h"
#include "vision/image/kernels/smoothing.h"

namespace faba {
namespace {

constexpr std::size_t kMostFrames = 64;
constexpr int kRadius = kLongestShift, kAcrossMotion = 6;  // px: displacements along and across
constexpr double kSurroundRatio = 2.5;                     // as in Detector
constexpr double kThresholdSd = 1.5, kObjectSd = 4;        // of the noise of the band-passed picture
constexpr int kPairBlocks = 5;                             // of the pairs
constexpr double kShiftSizes = 1.25;                       // displacement in sizes of an object
// Standard deviation of the displacements over their mean, at least. Thesis: 45 / 186 for IT-1. Without a
// limit a few objects with equal speeds, which correlate most, are taken for all. Assumed.
constexpr double kLeastShiftSpread = 0.15;
constexpr double kRoughStep = 0.5, kShiftStep = 0.1;  // px: grids of the fitted displacement
constexpr int kFineSteps = 5;                         // on each side of the rough displacement
constexpr double kLongestGap = 0.25;                  // s: cells turn and leave the picture
constexpr double kExplained = 0.8;                    // fraction of the variance that the model must explain
constexpr double kSignificant = 3;                    // standard errors of the fraction

using Profile = std::array<double, 2 * kRadius + 1>;  ///< against the displacement along, in px

std::size_t index_of(int displacement) {
  const int i = displacement + kRadius;
  return std::size_t(i);
}

/// A band-passed picture, and the pixels of its objects.
struct Sparse {
  GrayF band;                       ///< 0 below the threshold
  std::vector<SparsePixel> pixels;  ///< of objects, with the value 1
};

Sparse sparse_of(const GrayF& objects, double size_px, double noise) {
  Sparse s;
  const double sd = size_px / kFwhmPerSd;
  s.band = smoothed(objects, sd);
  const GrayF wide = smoothed(objects, kSurroundRatio * sd);
  const double noise_sd = noise / std::sqrt(4 * M_PI * sd * sd);
  const auto least = float(kThresholdSd * noise_sd), of_objects = float(kObjectSd * noise_sd);
  for (int r = 0; r < s.band.height; ++r)
    for (int c = 0; c < s.band.width; ++c) {
      const std::size_t i = std::size_t(r) * std::size_t(s.band.width) + std::size_t(c);
      const float v = s.band.px[i] - wide.px[i];
      s.band.px[i] = std::fabs(v) > least ? v : 0.0F;
      if (v > of_objects) s.pixels.push_back({c, r, 1});
    }
  return s;
}

// White noise of the video, treated as a picture.
Sparse noise_picture(const ResponseFrames& frames) {
  GrayF noise(frames.width(), frames.height());
  StudyRandom random(0, StudyDraws::measurement);
  for (float& v : noise.px) v = float(frames.noise() * random.normal());
  return sparse_of(noise, frames.object_px(), frames.noise());
}

/// Sums of a picture over the objects of another one against the displacement between the pixels, projected
/// on a direction.
class Correlator {
 public:
  explicit Correlator(double direction_deg)
      : along_{std::cos(direction_deg * kDegree), std::sin(direction_deg * kDegree)} {
    for (int dy = -kRadius; dy <= kRadius; ++dy)
      for (int dx = -kRadius; dx <= kRadius; ++dx)
        if (inside(dx, dy)) window_.include(dx, dy);
  }
  Vec2 along() const { return along_; }

  /// From the first picture to the second: the mean of the second one over the objects of the first and of
  /// the first one over the objects of the second. Several threads may call it at the same time.
  Profile between(const Sparse& a, const Sparse& b) const {
    const Profile forward = one_way(a, b), backward = &a == &b ? forward : one_way(b, a);
    Profile both{};
    for (std::size_t i = 0; i < both.size(); ++i)
      both[i] = 0.5 * (forward[i] + backward[both.size() - 1 - i]);
    return both;
  }

 private:
  Profile one_way(const Sparse& a, const Sparse& b) const {
    const CorrelationSums sums = window_.sums(a.pixels, b.band);
    Profile profile{};
    for (int dy = -kRadius; dy <= kRadius; ++dy)
      for (int dx = -kRadius; dx <= kRadius; ++dx) {
        if (!inside(dx, dy)) continue;
        const double s = dx * along_.x + dy * along_.y + kRadius, low = std::floor(s);
        const auto sum = double(sums.at(dx, dy));
        profile[std::size_t(low)] += (low + 1 - s) * sum;
        if (s > low) profile[std::size_t(low) + 1] += (s - low) * sum;
      }
    return profile;
  }
  bool inside(int dx, int dy) const {
    const double s = dx * along_.x + dy * along_.y, across = dy * along_.x - dx * along_.y;
    return std::fabs(s) <= kRadius - 1 && std::fabs(across) <= kAcrossMotion;
  }

  Vec2 along_;
  CorrelationWindow window_{kRadius};
};

/// Sums over the pairs of a block.
struct PairBlock {
  Profile next{}, self{};  ///< of pictures with later ones and with themselves
  /// Mass of the objects by the distance to the border at which they leave, in the first picture of a pair,
  /// or enter, in the second one.
  std::array<double, kRadius> at_border{};
  double mass = 0;  ///< of the objects in both pictures

  void add(const PairBlock& o, double sign) {
    for (std::size_t i = 0; i < next.size(); ++i) {
      next[i] += sign * o.next[i];
      self[i] += sign * o.self[i];
    }
    for (std::size_t i = 0; i < at_border.size(); ++i) at_border[i] += sign * o.at_border[i];
    mass += sign * o.mass;
  }
  /// Fraction of the objects of a picture that is in the other one, too, after a displacement.
  double remaining(double shift) const {
    double lost = 0;
    for (std::size_t i = 0; i < at_border.size() && double(i) < shift; ++i) lost += at_border[i];
    return mass > 0 ? 1 - lost / mass : 1;
  }
};

// `towards`: direction to the border.
void add_mass(PairBlock& b, const Sparse& s, Vec2 towards) {
  for (const SparsePixel& p : s.pixels) {
    const auto m = double(s.band.at(p.col, p.row));
    const double right = towards.x > 0 ? s.band.width - 1 - p.col : p.col;
    const double down = towards.y > 0 ? s.band.height - 1 - p.row : p.row;
    const double distance =
        std::min(right / std::max(std::fabs(towards.x), 1e-9), down / std::max(std::fabs(towards.y), 1e-9));
    b.mass += m;
    if (distance < kRadius) b.at_border[std::size_t(distance)] += m;
  }
}

/// The Gaussian distribution of displacements that fits the difference of both directions.
struct ShiftFit {
  double fraction = 0, shift = 0, sd = 0, explained = 0;
};

// Odd part of the correlation of objects with displacements N(shift, sd), for one object per object.
Profile template_of(const Profile& self, double shift, double sd) {
  Profile t{};
  double sum = 0;
  std::array<double, 2 * kRadius + 1> weight{};
  for (int u = -kRadius; u <= kRadius; ++u) {
    // Integral over the pixel, so that a narrow distribution is not missed between two of them.
    const double w =
        std::erf((u + 0.5 - shift) / (sd * M_SQRT2)) - std::erf((u - 0.5 - shift) / (sd * M_SQRT2));
    weight[index_of(u)] = w;
    sum += w;
  }
  for (int u = -kRadius; u <= kRadius; ++u) {
    const double w = weight[index_of(u)] / sum;
    if (w < 1e-6) continue;
    for (int s = -kRadius; s <= kRadius; ++s) {
      if (std::abs(s - u) <= kRadius) t[index_of(s)] += w * self[index_of(s - u)];
      if (std::abs(s + u) <= kRadius) t[index_of(s)] -= w * self[index_of(s + u)];
    }
  }
  return t;
}

// Values for s = 1 ... kRadius - 1 without their part proportional to s, which is due to the pairs of
// different objects: their density has a gradient where a swarm enters or leaves.
void remove_slope(std::array<double, kRadius>& values) {
  double sv = 0, ss = 0;
  for (int s = 1; s < kRadius; ++s) {
    sv += s * values[std::size_t(s)];
    ss += s * s;
  }
  for (int s = 1; s < kRadius; ++s) values[std::size_t(s)] -= s * sv / ss;
}

// `way`: 1 in the direction, -1 against it.
ShiftFit fit_with(const PairBlock& b, double shift, double sd, double way) {
  const Profile model = template_of(b.self, shift, sd);
  std::array<double, kRadius> t{}, a{};
  for (int s = 1; s < kRadius; ++s) {
    a[std::size_t(s)] = way * (b.next[index_of(s)] - b.next[index_of(-s)]);
    t[std::size_t(s)] = model[index_of(s)];
  }
  remove_slope(t);
  remove_slope(a);
  double tt = 0, ta = 0, aa = 0;
  for (std::size_t s = 1; s < kRadius; ++s) {
    tt += t[s] * t[s];
    ta += t[s] * a[s];
    aa += a[s] * a[s];
  }
  if (!(tt > 0) || !(aa > 0)) return {};
  return {ta / tt / b.remaining(shift), shift, sd, ta > 0 ? ta * ta / tt / aa : 0};
}

ShiftFit fit_of(const PairBlock& b, double size, double way) {
  ShiftFit best;
  const auto take = [&](double shift, double sd) {
    if (const ShiftFit f = fit_with(b, shift, std::max(sd, kLeastShiftSpread * shift), way);
        f.explained > best.explained)
      best = f;
  };
  const auto rough_shift = [&](int i) { return size / 4 + i * kRoughStep; };
  for (int i = 0; rough_shift(i) < kRadius - size; ++i)
    for (const double sd : {0.3, 0.7, 1.2, 2.0, 3.0, 4.5}) take(rough_shift(i), sd);
  const ShiftFit rough = best;
  for (int i = -kFineSteps; i <= kFineSteps; ++i)
    for (const double factor : {0.75, 0.9, 1.0, 1.15, 1.35})
      take(std::max(rough.shift + i * kShiftStep, 0.1), rough.sd * factor);
  return best;
}

// Correlation of each picture with itself. Noise correlates with itself only: it is not part of the objects.
std::vector<Profile> self_of(const std::vector<Sparse>& pictures, const Sparse& noise,
                             const Correlator& correlate, Pool& pool) {
  const Profile of_noise = correlate.between(noise, noise);
  std::vector<Profile> self(pictures.size());
  pool.run_uneven(pictures.size(), [&](std::size_t k) {
    self[k] = correlate.between(pictures[k], pictures[k]);
    for (std::size_t i = 0; i < of_noise.size(); ++i) self[k][i] -= of_noise[i];
  });
  return self;
}

std::vector<PairBlock> blocks_of(const std::vector<Sparse>& pictures, const std::vector<Profile>& self,
                                 std::size_t gap, const Correlator& correlate, Pool& pool) {
  std::vector<PairBlock> blocks(kPairBlocks);
  const std::size_t pairs = pictures.size() - gap;
  std::vector<Profile> next(pairs);
  pool.run_uneven(pairs, [&](std::size_t k) { next[k] = correlate.between(pictures[k], pictures[k + gap]); });
  for (std::size_t k = 0; k < pairs; ++k) {
    PairBlock& b = blocks[k * kPairBlocks / pairs];
    for (std::size_t i = 0; i < next[k].size(); ++i) {
      b.next[i] += next[k][i];
      b.self[i] += 0.5 * (self[k][i] + self[k + gap][i]);
    }
    add_mass(b, pictures[k], correlate.along());
    add_mass(b, pictures[k + gap], -1 * correlate.along());
  }
  return blocks;
}

// `least`: half width at least, for values on a grid.
std::array<double, 2> jackknife_interval(double value, const std::vector<double>& without, double least) {
  double mean = 0, squares = 0;
  for (const double v : without) mean += v / double(without.size());
  for (const double v : without) squares += (v - mean) * (v - mean);
  const auto n = double(without.size());
  const double half = std::max(least, student_t_quantile(0.95, n - 1) * std::sqrt((n - 1) / n * squares));
  return {value - half, value + half};
}

CommonDisplacement result_of(const std::vector<PairBlock>& blocks, const ShiftFit& fit, const PairBlock& all,
                             double size, double side, std::size_t gap) {
  std::vector<double> fractions, shifts;
  for (const PairBlock& b : blocks) {
    PairBlock rest = all;
    rest.add(b, -1);
    const ShiftFit f = fit_of(rest, size, 1);
    fractions.push_back(f.fraction);
    shifts.push_back(f.shift);
  }
  const double scale = side / double(gap);
  CommonDisplacement c;
  c.fraction = fit.fraction;
  c.shift_px = fit.shift * scale;
  c.fraction_ci90 = jackknife_interval(fit.fraction, fractions, 0);
  c.shift_ci90 = jackknife_interval(fit.shift, shifts, kShiftStep / 2);
  for (double& v : c.shift_ci90) v *= scale;
  c.clear = fit.explained > kExplained && c.fraction > 0 &&
            (c.fraction_ci90[1] - c.fraction) * kSignificant / student_t_quantile(0.95, kPairBlocks - 1) <
                c.fraction;
  c.opposite = fit_of(all, size, -1).fraction;
  c.gap = int(gap);
  return c;
}

}  // namespace

std::optional<CommonDisplacement> common_displacement(const ResponseFrames& frames, const VideoPart& part,
                                                      double direction_deg, double frame_s) {
  const double size = frames.object_px();
  std::vector<Sparse> pictures;
  std::vector<Sparse> slots(frames.slots());
  const auto work = [&](std::size_t slot, const GrayF& objects, double) {
    slots[slot] = sparse_of(objects, size, frames.noise());
  };
  frames.each(part, work, [&](std::size_t slot) {
    if (pictures.size() < kMostFrames) pictures.push_back(std::move(slots[slot]));
  });
  if (pictures.size() < kLeastShiftFrames) return {};
  Pool pool(frames.threads());
  const Correlator correlate(direction_deg);
  const std::vector<Profile> self = self_of(pictures, noise_picture(frames), correlate, pool);
  for (std::size_t gap = 1;; gap *= 2) {
    const std::vector<PairBlock> blocks = blocks_of(pictures, self, gap, correlate, pool);
    PairBlock all;
    for (const PairBlock& b : blocks) all.add(b, 1);
    if (!(all.mass > 0)) return {};
    const ShiftFit fit = fit_of(all, size, 1);
    const bool longer = fit.shift < kShiftSizes * size && 2 * double(gap) * frame_s <= kLongestGap &&
                        pictures.size() >= 2 * gap + kLeastShiftFrames;
    if (!longer) return result_of(blocks, fit, all, size, frames.side(), gap);
  }
}

}  // namespace faba
