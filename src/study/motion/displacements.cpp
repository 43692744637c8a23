#include "study/motion/displacements.h"

#include <algorithm>
#include <cmath>
#include <functional>
#include <utility>

#include "core/random/distributions.h"
#include "core/threads/parallel.h"
#include "core/units.h"
#include "core/vec.h"
#include "study/motion/displacement_sums.h"
#include "study/stats/study_random.h"

namespace faba {
namespace {

constexpr std::size_t kMostFrames = 64;
constexpr int kRadius = kLongestShift;
constexpr int kPairBlocks = 5;     // of the pairs
constexpr double kShiftSizes = 2;  // displacement in sizes of an object, at least
// Half of the width of the window across the motion, in sizes of an object. A narrow window has fewer of the
// objects that swim in other directions, whose number differs at random between both ways; a wide one has all
// objects that follow the field, whose directions scatter. Assumed, as the displacement above and the time
// below.
constexpr double kHalfWidthSizes = 1.4;
// Standard deviation of the displacements over their mean, at least. Thesis: 45 / 186 for IT-1. Without a
// limit a few objects with equal speeds, which correlate most, are taken for all. Assumed.
constexpr double kLeastShiftSpread = 0.15;
constexpr double kRoughStep = 0.5, kShiftStep = 0.1;  // px: grids of the fitted displacement
constexpr int kFineSteps = 5;                         // on each side of the rough displacement
constexpr double kLongestGap = 0.3;                   // s: cells turn and leave the picture
constexpr double kExplained = 0.8;                    // fraction of the variance that the model must explain
constexpr double kSignificant = 3;                    // standard errors of the fraction
// Fraction above which objects that swim in random directions hardly matter. What a part before the reversal
// has, slow and fast objects in other proportions, would matter more. Assumed.
constexpr double kMostRespond = 0.5;
constexpr double kEdgeSizes = 3;  // of an object: what is beside the edge of a drop. Assumed

// White noise of the video, treated as a picture.
ObjectPicture noise_picture(const ResponseFrames& frames) {
  GrayF noise(frames.width(), frames.height());
  StudyRandom random(0, StudyDraws::measurement);
  for (float& v : noise.px) v = float(frames.noise() * random.normal());
  return object_picture(noise, frames.object_px(), frames.noise());
}

/// Sums over the pairs of a block.
struct PairBlock {
  DisplacementSums next, self;  ///< of pictures with later ones and with themselves
  /// Mass of the objects by the distance to the border at which they leave, in the first picture of a pair,
  /// or enter, in the second one.
  std::array<double, kRadius> at_border{};
  double mass = 0;  ///< of the objects in both pictures

  void add(const PairBlock& o, double sign) {
    next.add(o.next, sign);
    self.add(o.self, sign);
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
void add_mass(PairBlock& b, const ObjectPicture& s, Vec2 towards) {
  for (const SparsePixel& p : s.pixels) {
    const auto m = double(s.light.at(p.col, p.row));
    const double right = towards.x > 0 ? s.light.width - 1 - p.col : p.col;
    const double down = towards.y > 0 ? s.light.height - 1 - p.row : p.row;
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
ShiftProfile template_of(const ShiftProfile& self, double shift, double sd) {
  ShiftProfile t{};
  double sum = 0;
  std::array<double, 2 * kRadius + 1> weight{};
  for (int u = -kRadius; u <= kRadius; ++u) {
    // Integral over the pixel, so that a narrow distribution is not missed between two of them.
    const double w =
        std::erf((u + 0.5 - shift) / (sd * M_SQRT2)) - std::erf((u - 0.5 - shift) / (sd * M_SQRT2));
    weight[profile_index(u)] = w;
    sum += w;
  }
  for (int u = -kRadius; u <= kRadius; ++u) {
    const double w = weight[profile_index(u)] / sum;
    if (w < 1e-6) continue;
    for (int s = -kRadius; s <= kRadius; ++s) {
      if (std::abs(s - u) <= kRadius) t[profile_index(s)] += w * self[profile_index(s - u)];
      if (std::abs(s + u) <= kRadius) t[profile_index(s)] -= w * self[profile_index(s + u)];
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

/// What a distribution of displacements is fitted to.
struct FitInput {
  const PairBlock& block;
  ShiftProfile next, self;  ///< its sums in a window
  double way = 1;           ///< 1 in the direction, -1 against it
};

ShiftFit fit_with(const FitInput& in, double shift, double sd) {
  const ShiftProfile model = template_of(in.self, shift, sd);
  std::array<double, kRadius> t{}, a{};
  for (int s = 1; s < kRadius; ++s) {
    a[std::size_t(s)] = in.way * (in.next[profile_index(s)] - in.next[profile_index(-s)]);
    t[std::size_t(s)] = model[profile_index(s)];
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
  return {ta / tt / in.block.remaining(shift), shift, sd, ta > 0 ? ta * ta / tt / aa : 0};
}

ShiftFit fit_of(const PairBlock& block, const ShiftWindow& window, double size, double way) {
  const FitInput in{block, block.next.profile(window), block.self.profile(window), way};
  ShiftFit best;
  const auto take = [&](double shift, double sd) {
    if (const ShiftFit f = fit_with(in, shift, std::max(sd, kLeastShiftSpread * shift));
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

/// Pictures, and the correlation of each with itself. Noise correlates with itself only: it is not part of
/// the objects.
struct Pictures {
  std::vector<ObjectPicture> pictures;
  std::vector<DisplacementSums> self;
};

Pictures pictures_of(const ResponseFrames& frames, const VideoPart& part, const ObjectPicture& noise,
                     const PictureCorrelator& correlate, Pool& pool) {
  Pictures p;
  std::vector<ObjectPicture> slots(frames.slots());
  const auto work = [&](std::size_t slot, const GrayF& objects, double) {
    slots[slot] = object_picture(objects, frames.object_px(), frames.noise());
  };
  frames.each(part, work, [&](std::size_t slot) {
    if (p.pictures.size() < kMostFrames) p.pictures.push_back(std::move(slots[slot]));
  });
  const DisplacementSums of_noise = correlate.between(noise, noise);
  p.self.resize(p.pictures.size());
  pool.run_uneven(p.pictures.size(), [&](std::size_t k) {
    p.self[k] = correlate.between(p.pictures[k], p.pictures[k]);
    p.self[k].add(of_noise, -1);
  });
  return p;
}

// What swims against the direction swims along it backwards in time.
Pictures played_backwards(Pictures p) {
  std::reverse(p.pictures.begin(), p.pictures.end());
  std::reverse(p.self.begin(), p.self.end());
  return p;
}

std::vector<PairBlock> blocks_of(const Pictures& p, std::size_t gap, Vec2 along,
                                 const PictureCorrelator& correlate, Pool& pool) {
  std::vector<PairBlock> blocks(kPairBlocks);
  const std::size_t pairs = p.pictures.size() - gap;
  std::vector<DisplacementSums> next(pairs);
  pool.run_uneven(pairs,
                  [&](std::size_t k) { next[k] = correlate.between(p.pictures[k], p.pictures[k + gap]); });
  for (std::size_t k = 0; k < pairs; ++k) {
    PairBlock& b = blocks[k * kPairBlocks / pairs];
    b.next.add(next[k], 1);
    b.self.add(p.self[k], 0.5);
    b.self.add(p.self[k + gap], 0.5);
    add_mass(b, p.pictures[k], along);
    add_mass(b, p.pictures[k + gap], -1 * along);
  }
  return blocks;
}

double mass_of(const ObjectPicture& s, const std::function<bool(Vec2)>& counts) {
  double mass = 0;
  for (const SparsePixel& p : s.pixels)
    if (counts({double(p.col), double(p.row)})) mass += double(s.light.at(p.col, p.row));
  return mass;
}

double still_at_edge(const ResponseFrames& frames, const std::vector<ObjectPicture>& pictures) {
  if (!frames.edge()) return 0;
  const Circle& edge = *frames.edge();
  double all = 0;
  for (const ObjectPicture& s : pictures) all += mass_of(s, [](Vec2) { return true; });
  const double still =
      mass_of(object_picture(frames.still(), frames.object_px(), frames.noise()), [&](Vec2 at) {
        return std::fabs(norm(at - edge.centre) - edge.radius) < kEdgeSizes * frames.object_px();
      });
  return all > 0 ? still * double(pictures.size()) / all : 0;
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

/// The pairs of pictures of a part.
struct PicturePairs {
  std::vector<PairBlock> blocks;
  PairBlock all;

  explicit PicturePairs(std::vector<PairBlock> of) : blocks(std::move(of)) {
    for (const PairBlock& b : blocks) all.add(b, 1);
  }
  /// The values of all pairs without those of a block, for each block.
  template <class F>
  std::vector<double> without_a_block(const F& value) const {
    std::vector<double> values;
    for (const PairBlock& b : blocks) {
      PairBlock rest = all;
      rest.add(b, -1);
      values.push_back(value(rest));
    }
    return values;
  }
};

// The window turned to the direction in which the objects with about this displacement move, if it differs
// from the expected one by more than the 90 % interval.
ShiftWindow turned_to_motion(const PicturePairs& pairs, ShiftWindow window, double shift) {
  ShiftWindow wide = window;
  wide.half_width += PictureCorrelator::kMostTurn * shift;
  const auto across = [&](const PairBlock& b) { return b.next.across(wide, 0.5 * shift, 1.5 * shift); };
  const double off = across(pairs.all);
  const std::array<double, 2> interval = jackknife_interval(off, pairs.without_a_block(across), 0);
  if (interval[0] <= 0 && interval[1] >= 0) return window;
  const double turn =
      std::clamp(std::atan2(off, shift), -PictureCorrelator::kMostTurn, PictureCorrelator::kMostTurn);
  const double c = std::cos(turn), s = std::sin(turn);
  window.along = {c * window.along.x - s * window.along.y, s * window.along.x + c * window.along.y};
  return window;
}

// `scale`: px of the video per frame, of one px along the direction between two pictures.
ShiftedFraction result_of(const PicturePairs& pairs, const ShiftWindow& window, double size, double scale) {
  const ShiftFit fit = fit_of(pairs.all, window, size, 1);
  std::vector<double> shifts;
  const auto fraction = [&](const PairBlock& block) {
    const ShiftFit f = fit_of(block, window, size, 1);
    shifts.push_back(f.shift);
    return f.fraction;
  };
  ShiftedFraction r;
  r.fraction = {fit.fraction, jackknife_interval(fit.fraction, pairs.without_a_block(fraction), 0)};
  r.shift_px = {fit.shift * scale, jackknife_interval(fit.shift, shifts, kShiftStep / 2)};
  for (double& v : r.shift_px.ci90) v *= scale;
  const double error = (r.fraction.ci90[1] - fit.fraction) / student_t_quantile(0.95, kPairBlocks - 1);
  r.clear = fit.explained > kExplained && fit.fraction > 0 && kSignificant * error < fit.fraction;
  return r;
}

// The fraction of the objects with the displacements of another fit.
Measured fraction_with(const PicturePairs& pairs, const ShiftWindow& window, const ShiftFit& fit) {
  const auto fraction = [&](const PairBlock& b) {
    return fit_with({b, b.next.profile(window), b.self.profile(window)}, fit.shift, fit.sd).fraction;
  };
  const double value = fraction(pairs.all);
  return {value, jackknife_interval(value, pairs.without_a_block(fraction), 0)};
}

// The pairs of two parts, each part with the same weight.
PicturePairs together(const PicturePairs& a, const PicturePairs& b) {
  std::vector<PairBlock> blocks = a.blocks;
  for (std::size_t i = 0; i < blocks.size(); ++i) blocks[i].add(b.blocks[i], a.all.mass / b.all.mass);
  return PicturePairs(std::move(blocks));
}

}  // namespace

std::optional<CommonDisplacement> common_displacement(const ResponseFrames& frames,
                                                      const ResponseParts& parts, double direction_deg,
                                                      double frame_s) {
  const double size = frames.object_px();
  Pool pool(frames.threads());
  const Vec2 along{std::cos(direction_deg * kDegree), std::sin(direction_deg * kDegree)};
  const ShiftWindow window{along, kHalfWidthSizes * size};
  const PictureCorrelator correlate(window);
  const ObjectPicture noise = noise_picture(frames);
  const Pictures after = pictures_of(frames, parts.after, noise, correlate, pool);
  if (after.pictures.size() < kLeastShiftFrames) return {};
  for (std::size_t gap = 1;; gap *= 2) {
    const PicturePairs pairs(blocks_of(after, gap, along, correlate, pool));
    if (!(pairs.all.mass > 0)) return {};
    const double shift = fit_of(pairs.all, window, size, 1).shift;
    const bool longer = shift < kShiftSizes * size && 2 * double(gap) * frame_s <= kLongestGap &&
                        after.pictures.size() >= 2 * gap + kLeastShiftFrames;
    if (longer) continue;
    const ShiftWindow turned = turned_to_motion(pairs, window, shift);
    const double scale = frames.side() / double(gap);
    CommonDisplacement c;
    c.after = result_of(pairs, turned, size, scale);
    c.opposite = fit_of(pairs.all, turned, size, -1).fraction;
    c.gap = int(gap);
    c.still_at_edge = still_at_edge(frames, after.pictures);
    if (!parts.before || !c.after.clear || c.after.fraction.value > kMostRespond) return c;
    const Pictures before = played_backwards(pictures_of(frames, *parts.before, noise, correlate, pool));
    if (before.pictures.size() < gap + kPairBlocks) return c;
    const PicturePairs earlier(blocks_of(before, gap, along, correlate, pool));
    if (!(earlier.all.mass > 0)) return c;
    c.before = fraction_with(earlier, turned, fit_of(pairs.all, turned, size, 1));
    c.both = result_of(together(pairs, earlier), turned, size, scale);
    return c;
  }
}

}  // namespace faba
