#include "study/coils/field_units.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>

#include "core/error.h"
#include "study/coils/field_model.h"

namespace faba {
namespace {

/// Values are `factor` times too large when the unit of the table is not the unit in which they were
/// measured.
struct Mistake {
  double factor;
  const char* as;
};
constexpr Mistake kLengths[] = {{1e3, "mm read as m"},       {1e2, "cm read as m"},
                                {10, "mm read as cm"},       {0.1, "cm read as mm"},
                                {1e-2, "m read as cm"},      {1e-3, "m read as mm"},
                                {25.4, "mm read as inches"}, {1 / 25.4, "inches read as mm"}};
constexpr Mistake kFields[] = {{1e6, "uT read as T"},
                               {1e4, "G read as T"},
                               {1e3, "mT read as T, or uT as mT"},
                               {1e2, "uT read as G"},
                               {10, "G read as mT"},
                               {0.1, "mT read as G"},
                               {1e-2, "G read as uT"},
                               {1e-3, "T read as mT, or mT as uT"},
                               {1e-4, "T read as G"},
                               {1e-6, "T read as uT"}};
constexpr double kGood = 0.1;    // assumed, as in the check of the residual
constexpr double kBetter = 0.3;  // of the residual in the units of the table
constexpr double kNear = 2;      // assumed: currents, turns and dimensions are known to this factor

std::string smaller(const char* what, const Mistake& m) {
  return m.factor > 1 ? fmt::format("{} are {:g} times smaller, as of {}", what, m.factor, m.as)
                      : fmt::format("{} are {:g} times larger, as of {}", what, 1 / m.factor, m.as);
}

const Mistake* field_mistake(double gain) {
  for (const Mistake& m : kFields)
    if (gain / m.factor > 1 / kNear && gain / m.factor < kNear) return &m;
  return nullptr;
}

struct Rescaled {
  double residual = std::numeric_limits<double>::infinity(), gain = 1;
};

// The fit with all lengths divided by `factor`. Its residual is infinite if the lengths determine nothing.
Rescaled rescaled(const Field& field, FieldData data, Vec3 centre, double factor) {
  for (Vec3& p : data.at) p = (1 / factor) * p;
  // The search starts at a gain of 1.
  const FieldModel given(field, data, centre, {});
  double square = 0;
  for (const double b : given.predicted(Eigen::VectorXd::Ones(given.parameters()))) square += b * b;
  const double ratio = given.strength() / std::sqrt(square / double(given.values().size()));
  if (!(ratio > 0) || !std::isfinite(ratio)) return {};
  for (Vec3& b : data.b) b = (1 / ratio) * b;
  FieldModel model(field, data, centre, {});
  try {
    const DeterminedFit fit = determined_fit(model, data.source);
    if (fit.degenerate) return {};
    return {fit.solution.rms, ratio * model.meaning(fit.solution.x).gain};
  } catch (const Error&) {
    return {};
  }
}

}  // namespace

std::optional<LikelyUnits> likely_field_unit(double gain) {
  const Mistake* m = field_mistake(gain);
  if (!m) return std::nullopt;
  const std::string change = smaller("the values of the field", *m);
  return LikelyUnits{change, fmt::format("the gain is {:.2g} if {}", gain / m->factor, change)};
}

std::optional<LikelyUnits> likely_units(const Field& field, const FieldData& data, std::optional<Vec3> centre,
                                        double residual) {
  std::optional<LikelyUnits> best;
  double smallest = std::min(kGood, kBetter * residual);
  const auto attempt = [&](const Mistake* length) {
    const Rescaled r = rescaled(field, data, centre.value_or(Vec3{}), length ? length->factor : 1);
    const bool same_field = r.gain > 1 / kNear && r.gain < kNear;
    const Mistake* strength = same_field ? nullptr : field_mistake(r.gain);
    if (!(r.residual < smallest) || (!same_field && !strength) || (!length && !strength)) return;
    smallest = r.residual;
    std::string change = length ? smaller("the lengths", *length) : "";
    if (strength) change += (length ? " and " : "") + smaller("the values of the field", *strength);
    best = LikelyUnits{change,
                       fmt::format("the residual is {:.2g} % of the field and the gain is {:.2g} if {}",
                                   100 * r.residual, r.gain / (strength ? strength->factor : 1), change)};
  };
  attempt(nullptr);
  if (best) return best;  // one wrong unit is more likely than two
  for (const Mistake& length : kLengths) attempt(&length);
  return best;
}

}  // namespace faba
