#include "study/uturn/moment_warnings.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

namespace faba {
namespace {

// With frame-averaged velocities the estimate is wrong by (w dt)^2 / 36 (theory B3.10), and a turn of pi / w
// has pi / (w dt) frames: six at 0.5.
constexpr double kLargeAngle = 0.5, kUnresolvedAngle = 1;
// kappa = 5: the mean cosine of aligned cells is 0.89, and the angle of a cell to the field exceeds 60
// degrees in 1 % of the time.
constexpr double kWeakField = 0.2;
constexpr double kTilted =
    0.85;  // a turn in a plane tilted by 30 degrees has 0.87 of the speed across the field
constexpr double kFewTurning = 0.5;      // assumed
constexpr std::uint64_t kFewTurns = 20;  // the median of 20 turns has an interval of +- 46 % / sqrt(kappa)

void check_field(const FieldStrength& f, std::vector<Warning>& out) {
  const UTurnSurvey& s = f.survey;
  const std::string name = fmt::format("{}, {:.3g} mT", f.file.filename().string(), 1e3 * f.field_t);
  if (!s.unseen_s.empty())
    out.push_back({"reversal", "no cells turn after a reversal",
                   fmt::format("{}: at {:.3g} s", name, s.unseen_s.front()),
                   "check `reversals` and `field`, or use a stronger field"});
  if (s.turns.empty() || !f.rate_per_t) return;
  const double angle = f.rate_per_t->median * f.field_t * s.frame_s;
  if (angle > kLargeAngle)
    out.push_back({"frame rate", "the cells turn too far between frames",
                   fmt::format("{}: {:.2g} rad per frame, at most {}", name, angle, kLargeAngle),
                   fmt::format("use at most {:.2g} mT at this frame rate, or {:.0f} frames per second",
                               1e3 * f.field_t * kLargeAngle / angle, angle / kLargeAngle / s.frame_s),
                   angle > kUnresolvedAngle ? Quality::poor : Quality::doubtful});
  if (s.disorder > kWeakField)
    out.push_back({"field", "the cells are not aligned with the field before and after the turns",
                   fmt::format("{}: <sin^2>/<cos> {:.2g}, at most {}", name, s.disorder, kWeakField),
                   fmt::format("use at least {:.2g} mT", 1e3 * f.field_t * s.disorder / kWeakField)});
  if (s.turn_speed && *s.turn_speed < kTilted)
    out.push_back(
        {"tilt", "the cells turn out of the plane of the picture: the moment is overestimated",
         fmt::format("{}: speed across the field {:.0f} % of that along it", name, 100 * *s.turn_speed),
         "use a chamber not much deeper than the cells", Quality::poor});
  if (double(s.turns.size()) < kFewTurning * double(s.cells))
    out.push_back(
        {"response", "many moving cells do not complete a turn",
         fmt::format("{}: {} of {}", name, s.turns.size(), s.cells),
         "record longer after each reversal; cells that reverse their swimming direction do not count"});
}

// Whether the rate per field is equal for all strengths: chi-squared about the weighted mean.
void check_proportional(const MomentEstimate& m, std::vector<Warning>& out) {
  constexpr double kSdOf90 = 3.29;  // width of a 90 % interval in standard deviations
  std::vector<const FieldStrength*> known;
  for (const FieldStrength& f : m.fields)
    if (f.rate_per_t) known.push_back(&f);
  const auto differs = [&](const auto* f) { return f->field_t != known.front()->field_t; };
  if (known.empty()) return;
  if (std::none_of(known.begin(), known.end(), differs)) {
    out.push_back({"field strengths",
                   "one field strength: whether the rate is proportional to it was not checked",
                   fmt::format("{:.3g} mT", 1e3 * known.front()->field_t),
                   "record at half and twice this field", Quality::good});
    return;
  }
  double weight = 0, sum = 0, squares = 0;
  for (const auto* f : known) {
    const double sd = std::log(f->rate_per_t->ci90[1] / f->rate_per_t->ci90[0]) / kSdOf90,
                 y = std::log(f->rate_per_t->median);
    weight += 1 / (sd * sd);
    sum += y / (sd * sd);
    squares += y * y / (sd * sd);
  }
  const double chi2 = squares - sum * sum / weight, freedom = double(known.size() - 1);
  // Wilson and Hilferty: the cube root of chi-squared over its degrees of freedom is nearly normal.
  const double limit = freedom * std::pow(1 - 2 / (9 * freedom) + 2.33 * std::sqrt(2 / (9 * freedom)), 3);
  if (!(chi2 > limit)) return;
  const auto [low, high] = std::minmax_element(known.begin(), known.end(), [](const auto* a, const auto* b) {
    return a->rate_per_t->median < b->rate_per_t->median;
  });
  out.push_back(
      {"field strengths", "the turning rate is not proportional to the field",
       fmt::format("{:.3g} per s and mT at {:.3g} mT, {:.3g} at {:.3g} mT", 1e-3 * (*low)->rate_per_t->median,
                   1e3 * (*low)->field_t, 1e-3 * (*high)->rate_per_t->median, 1e3 * (*high)->field_t),
       "check the fields; in strong fields flagella limit the turning, use the weaker fields"});
}

}  // namespace

std::vector<Warning> moment_warnings(const MomentEstimate& m, const std::optional<CellBody>& cell) {
  std::vector<Warning> out;
  for (const FieldStrength& f : m.fields) check_field(f, out);
  if (m.turns < kFewTurns)
    out.push_back({"turns", m.turns == 0 ? "no complete turns were found" : "few complete turns were found",
                   fmt::format("{}, at least {}", m.turns, kFewTurns), "record more reversals or more cells",
                   m.turns < kFewTurns / 4 ? Quality::poor : Quality::doubtful});
  check_proportional(m, out);
  if (cell && cell->drag_sd == 0)
    out.push_back({"drag", "the drag has no uncertainty: the interval of the moment is too narrow",
                   "drag_sd = 0", "give drag_sd, three times the relative uncertainty of the size"});
  return out;
}

}  // namespace faba
