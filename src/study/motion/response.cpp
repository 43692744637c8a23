#include "study/motion/response.h"

#include <algorithm>
#include <cmath>
#include <vector>

#include "study/motion/displacements.h"
#include "study/motion/segments.h"
#include "study/tracks/cell_view.h"

namespace faba {
namespace {

constexpr double kReadBefore = 0.8, kReadAfter = 4;  // s about a known reversal that are read
constexpr double kMostSearched = 20;                 // s: part in which an unknown reversal is searched
constexpr double kHalfSearch = 0.5;   // s before and after a possible change that are compared in the search
constexpr double kEarlier = 0.5;      // s before the detected change at which the search of the onset starts
constexpr double kNormal90 = 1.645;   // quantile of the normal distribution for a 90 % interval
constexpr double kAnyDirection = 12;  // independent possibilities of a direction that is not given. Assumed

// Half widths of the 90 % interval of their difference by which the fractions before and after a reversal may
// differ: equal ones hardly differ by more. Assumed.
constexpr double kDiffer = 1.5;

/// The components of one measure.
struct ShiftComponents {
  std::vector<double> along, across;
};

ShiftComponents components_of(const std::vector<Vec2>& shifts, Vec2 d) {
  ShiftComponents c;
  for (const Vec2 s : shifts) {
    c.along.push_back(dot(s, d));
    c.across.push_back(s.y * d.x - s.x * d.y);
  }
  return c;
}

Vec2 mean_between(const PairShifts& p, const std::vector<Vec2>& shifts, double from, double to) {
  Vec2 sum;
  double n = 0;
  for (std::size_t k = 0; k < p.size(); ++k)
    if (p.t0_s[k] >= from && p.t1_s[k] <= to) {
      sum = sum + shifts[k];
      n += 1;
    }
  return n > 0 ? (1 / n) * sum : Vec2{};
}

/// The largest change between two means over kHalfSearch, relative to the scatter of such changes.
struct Change {
  double t_s = 0, score = 0;
  Vec2 step;
};

Change largest_change(const PairShifts& p, const std::vector<Vec2>& shifts,
                      const std::optional<double>& direction) {
  Change best;
  std::vector<double> sizes;
  for (std::size_t k = 0; k < p.size(); ++k) {
    const double t = p.t0_s[k];
    if (t < p.t0_s.front() + kHalfSearch || t > p.t1_s.back() - kHalfSearch) continue;
    const Vec2 step =
        mean_between(p, shifts, t, t + kHalfSearch) - mean_between(p, shifts, t - kHalfSearch, t);
    const double size = direction ? dot(step, unit_vector(*direction)) : norm(step);
    sizes.push_back(std::fabs(size));
    if (size > best.score) best = {t, size, step};
  }
  if (sizes.empty()) return {};
  std::nth_element(sizes.begin(), sizes.begin() + std::ptrdiff_t(sizes.size() / 2), sizes.end());
  best.score /= std::max(sizes[sizes.size() / 2], 1e-9);
  return best;
}

// The change of the measure in which the response is clearest, with its time and direction; whether there is
// one.
bool take_clearest(Response& r, const PairShifts& p, const ResponseJob& job, double latest) {
  bool found = false;
  for (const ShiftMeasure m : kShiftMeasures) {
    double earliest = r.earliest_s, direction = r.direction_deg;
    if (!job.reversal_s) {
      const Change change = largest_change(p, p.of(m), job.direction_deg);
      if (!(change.score > 0)) continue;
      earliest = change.t_s - kEarlier;
      if (!job.direction_deg) direction = direction_of(change.step);
    } else if (!job.direction_deg) {
      direction = direction_of(mean_between(p, p.of(m), earliest + kHalfSearch, earliest + 3 * kHalfSearch) -
                               mean_between(p, p.of(m), earliest - kReadBefore, earliest));
    }
    const ShiftComponents c = components_of(p.of(m), unit_vector(direction));
    const auto change =
        change_point({p.t0_s, p.t1_s, c.along, c.across}, earliest, std::min(latest, earliest + kReadAfter));
    if (!change || (found && change->t_statistic <= r.change.t_statistic)) continue;
    found = true;
    r.change = *change;
    r.earliest_s = earliest;
    r.direction_deg = direction;
    r.measure = word_of(m);
  }
  const double searched = p.t1_s.back() - job.reversal_s.value_or(p.t0_s.front());
  const double others = double(kShiftMeasures.size()) * (job.direction_deg ? 1 : kAnyDirection);
  r.responds = found && r.change.after > 0 && r.change.t_statistic > least_t(r.change, searched, others);
  return found;
}

// The direction of the clearest change when the given one is ignored, if it is significant.
std::optional<double> changed_direction(const PairShifts& p, ResponseJob job, double latest) {
  job.direction_deg.reset();
  Response any;
  any.earliest_s = job.reversal_s.value_or(job.part.from_s);
  if (!take_clearest(any, p, job, latest) || !any.responds) return {};
  return any.direction_deg;
}

std::array<double, 2> clipped(std::array<double, 2> interval) {
  for (double& v : interval) v = std::clamp(v, 0.0, 1.0);
  return interval;
}

// Variance of a fraction, times the number of objects, due to those that swim in random directions: less than
// half of those that do not respond are in the window about the axis of the response, and add 1 or -1.
double swimming_variance(double fraction) { return 0.5 * (1 - fraction); }

// Variance of a fraction: the objects in view are a sample, with at least the binomial variance of one
// object; those that swim in random directions are independent in different parts of a video.
double sampling_variance(double fraction, double objects, double parts) {
  const double p = std::clamp(fraction, 1 / objects, 1 - 1 / objects);
  return (p * (1 - p) + swimming_variance(p) / parts) / objects;
}

// With an interval widened for the sample of objects, if their number is known.
Measured sampled(Measured f, const std::optional<double>& objects, double parts) {
  f = {std::min(f.value, 1.0), clipped(f.ci90)};
  const double error = objects ? kNormal90 * std::sqrt(sampling_variance(f.value, *objects, parts)) : 0;
  f.ci90 = {f.value - std::hypot(f.value - f.ci90[0], error),
            f.value + std::hypot(f.ci90[1] - f.value, error)};
  return {f.value, clipped(f.ci90)};
}

// Whether before the reversal objects swam the other way, as many of them as after it.
bool both_ways(const CommonDisplacement& common, double objects) {
  if (!common.before || !common.both.clear) return false;
  const Measured &after = common.after.fraction, &before = *common.before;
  const auto error = [&](const Measured& m) {
    return std::hypot((m.ci90[1] - m.ci90[0]) / 2,
                      kNormal90 * std::sqrt(swimming_variance(std::clamp(m.value, 0.0, 1.0)) / objects));
  };
  return before.value > error(before) &&
         std::fabs(after.value - before.value) < kDiffer * std::hypot(error(after), error(before));
}

// Speed and fraction of a response. With free space around the swarm, the fraction is the velocity of the
// centroid of all objects over the speed of the responding objects. Otherwise the part before the reversal
// counts, too, if it is alike: of the objects that swim in random directions more swim along the response
// than against it, or fewer, and while they keep their directions the error has the opposite sign there.
void take_speed(Response& r, const CommonDisplacement& common, const ResponseFrames& frames,
                const ResponseJob& job) {
  if (!r.responds) {
    const double most = std::max(common.after.fraction.value, common.opposite);
    r.fraction = sampled({0, {0, most}}, job.objects, 1);
    r.fraction_method = "image correlation";
    return;
  }
  r.still_at_edge = common.still_at_edge;
  if (!common.after.clear) return;
  const bool both = job.objects && both_ways(common, *job.objects);
  const ShiftedFraction& shifted = both ? common.both : common.after;
  const Measured& shift = shifted.shift_px;
  r.speed_px_s = {shift.value / job.frame_s, {shift.ci90[0] / job.frame_s, shift.ci90[1] / job.frame_s}};
  r.flow = FlowVerdict{shift.value, frames.object_px() * frames.side(), {}};
  r.fraction = sampled(shifted.fraction, job.objects, both ? 2 : 1);
  r.fraction_method = both ? "image correlation before and after the reversal" : "image correlation";
  if (r.measure != word_of(ShiftMeasure::centroid)) return;
  const double ratio = r.change.after / shift.value;
  const double error = std::hypot((r.change.after - r.change.before) / r.change.t_statistic / r.change.after,
                                  (shift.ci90[1] / shift.value - 1) / kNormal90);
  r.fraction =
      sampled({ratio, {ratio * (1 - kNormal90 * error), ratio * (1 + kNormal90 * error)}}, job.objects, 1);
  r.fraction_method = "centroid over image correlation";
}

// The parts in which the fraction is measured. A swarm with free space around it, and objects at the edge of
// a drop in view, are measured after the reversal only: before it they may have been at the edge.
ResponseParts parts_of(const Response& r, const ResponseFrames& frames, const VideoPart& part,
                       std::optional<double> reversal_s) {
  ResponseParts parts{part, {}};
  parts.after.from_s = r.change.t_s + r.change.rise_s + kResponseWait;
  parts.after.to_s = parts.after.from_s + kResponsePart;
  if (frames.edge() || r.measure == word_of(ShiftMeasure::centroid)) return parts;
  parts.before = part;
  parts.before->to_s = reversal_s.value_or(r.change.ci90[0]);
  parts.before->from_s = std::max(part.from_s, *parts.before->to_s - kResponsePart);
  return parts;
}

}  // namespace

VideoPart response_part(const ResponseJob& job) {
  VideoPart part = job.part;
  const double end = job.part.to_s.value_or(1e300);
  if (job.reversal_s) {
    part.from_s = std::max(0.0, *job.reversal_s - kReadBefore);
    part.to_s = std::min(end, *job.reversal_s + kReadAfter);
  } else {
    part.to_s = std::min(end, job.part.from_s + kMostSearched);
  }
  return part;
}

std::optional<Response> measure_response(const ResponseJob& job) {
  const VideoPart part = response_part(job);
  const ResponseFrames frames(job.video, part, job.threads, job.check, job.pictures);
  if (frames.frames() < 2) return {};
  const PairShifts shifts = pair_shifts(frames, part);
  Response r;
  r.earliest_s = job.reversal_s.value_or(part.from_s);
  r.direction_deg = job.direction_deg.value_or(0);
  if (!take_clearest(r, shifts, job, *part.to_s)) return {};
  if (!r.responds && job.direction_deg) r.other_direction_deg = changed_direction(shifts, job, *part.to_s);
  const ResponseParts parts = parts_of(r, frames, part, job.reversal_s);
  if (const auto common = common_displacement(frames, parts, r.direction_deg, job.frame_s))
    take_speed(r, *common, frames, job);
  return r;
}

}  // namespace faba
