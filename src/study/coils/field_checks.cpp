#include "study/coils/field_checks.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>
#include <optional>

#include "study/coils/field_units.h"

namespace faba {
namespace {

constexpr double kLargeResidual = 0.1;  // assumed: errors of probe and formulas are a few hundredths

double& component(Vec3& v, std::size_t k) { return k == 0 ? v.x : k == 1 ? v.y : v.z; }

std::optional<Warning> check_gain(const FieldFit& fit) {
  const double gain = fit.best.gain, se = fit.standard_error.gain;
  if (!(std::fabs(gain) > fit.t95 * se))
    return Warning{"signal", "the table shows no field of the coils: its gain may be zero",
                   fmt::format("gain {:.2g} +- {:.2g}", gain, se),
                   "check the columns, the current of the coils and the distance of the points",
                   Quality::poor};
  if (gain < 0)
    return Warning{"direction", "the gain is negative: the direction of a current or an axis is reversed",
                   fmt::format("gain {:.3g}", gain), "reverse the current or the axis", Quality::poor};
  if (gain >= 0.5 && gain <= 2) return std::nullopt;
  const auto unit = likely_field_unit(gain);
  return Warning{"gain", "the gain is far from 1",
                 fmt::format("gain {:.3g}{}", gain, unit ? "; " + unit->evidence : ""),
                 unit ? "check the unit of the field (--units), the turns and the current"
                      : "check the turns, the current and the units",
                 gain < 0.1 || gain > 10 ? Quality::poor : Quality::doubtful};
}

// Of a poor fit.
std::optional<Warning> check_units(const FittedField& f, double residual) {
  if (residual < kLargeResidual) return std::nullopt;
  const auto units = likely_units(f.field, f.data, f.centre, residual);
  if (!units) return std::nullopt;
  return Warning{"units", "a unit of the table is probably wrong",
                 fmt::format("{}; it is {:.2g} % in the units of the table", units->evidence, 100 * residual),
                 "correct the header, or give the units with --units", Quality::poor};
}

// The largest reading, if several readings have it and the fit to the others predicts a larger field there.
std::optional<Warning> check_saturation(const FittedField& f) {
  constexpr std::size_t kReadings = 3;  // fewer may be equal by rounding
  // Rounding to q causes an error of at most q / 2, 1.7 of its standard deviations.
  constexpr double kBeyondRounding = 3;
  for (std::size_t k = 0; k < 3; ++k) {
    if (!f.data.given[k]) continue;
    FieldData others = f.data, equal = f.data;
    double largest = 0;
    for (Vec3& b : equal.b) largest = std::max(largest, std::fabs(component(b, k)));
    for (FieldData* d : {&others, &equal}) {
      const bool keep_largest = d == &equal;
      std::size_t kept = 0;
      for (std::size_t i = 0; i < d->b.size(); ++i) {
        if ((std::fabs(component(d->b[i], k)) == largest) != keep_largest) continue;
        d->at[kept] = d->at[i];
        d->b[kept++] = d->b[i];
      }
      d->at.resize(kept);
      d->b.resize(kept);
    }
    if (equal.at.size() < kReadings) continue;
    FieldModel model(f.field, others, f.centre.value_or(Vec3{}), {});
    if (Eigen::Index(model.values().size()) <= model.parameters()) continue;
    const DeterminedFit d = determined_fit(model, f.data.source);
    const FieldFit::Values m = model.meaning(d.solution.x);
    std::vector<Vec3> at = equal.at, b(at.size());
    for (Vec3& p : at) p = p - Vec3{m.shift[0], m.shift[1], m.shift[2]};
    const std::vector<double> current = f.field.default_currents();
    f.field.at(at, current, b);
    double excess = 0;
    for (Vec3& v : b) {
      Vec3 ambient = f.field.ambient();
      const double background = component(ambient, k);
      excess += std::fabs(m.gain * (component(v, k) - background) + background + m.offset[k]) - largest;
    }
    excess /= double(b.size());
    if (excess > kBeyondRounding * d.solution.rms * model.strength())
      return Warning{"saturation", "the largest readings are equal: the probe was at the end of its range",
                     fmt::format("{} readings are {:.4g} mT; the others predict {:.4g} mT there", b.size(),
                                 1e3 * largest, 1e3 * (largest + excess)),
                     "remove these lines, or measure with a larger range", Quality::poor};
  }
  return std::nullopt;
}

// Measurement errors are independent; residuals that depend on their neighbours are errors of the model.
std::optional<Warning> check_structure(const FittedField& f, double residual) {
  constexpr double kFine = 1e-3;  // assumed: no probe is calibrated better
  if (residual < kFine) return std::nullopt;
  const std::vector<double> predicted = f.model.predicted(f.fit.solution.x);
  const auto& measured = f.model.values();
  const auto stride = std::size_t(std::count(f.data.given.begin(), f.data.given.end(), true));
  double product = 0, square = 0;
  for (std::size_t i = 0; i < measured.size(); ++i) {
    const double e = measured[i] - predicted[i];
    square += e * e;
    if (i >= stride) product += e * (measured[i - stride] - predicted[i - stride]);
  }
  // The correlation of n independent values has the standard deviation 1 / sqrt(n): false in 1 of 1000.
  const double r = product / square, limit = 3.1 / std::sqrt(double(measured.size()));
  if (r < limit) return std::nullopt;
  return Warning{
      "residual", "the residuals of neighbouring points are correlated: the intervals are too narrow",
      fmt::format("correlation {:.2f}, of independent errors at most {:.2f}", r, limit),
      "check the dimensions of the coils and the position of the scan across the axis; see --picture"};
}

// Whether another size of the single coil would fit better, or equally well.
std::optional<Warning> check_size(const FittedField& f, double t95, std::vector<std::string>& undetermined) {
  constexpr double kSmall = 0.02;  // assumed: accuracy of the dimensions of a coil
  constexpr double kUndetermined = 0.5;
  if (!f.centre || std::size_t(f.model.parameters()) + 1 >= f.model.values().size()) return std::nullopt;
  FieldModel model = f.model;
  model.add_size();
  Eigen::VectorXd x(model.parameters());
  x << f.fit.solution.x, 1;
  const FieldStep step = step_from(model, x);
  const double change = step.change[x.size() - 1], se = step.standard_error[x.size() - 1];
  if (se > kUndetermined) {
    undetermined.push_back("size");
    return std::nullopt;
  }
  if (std::fabs(change) < kSmall || std::fabs(change) < t95 * se) return std::nullopt;
  return Warning{"size", "a coil of another size fits better: gain and shift are for the size in the file",
                 fmt::format("radius and length {:.0f} +- {:.0f} % {}", 100 * std::fabs(change),
                             100 * t95 * se, change > 0 ? "larger" : "smaller"),
                 "measure the coil and correct its dimensions"};
}

std::optional<Warning> check_axis(const FittedField& f, double residual) {
  if (residual < kLargeResidual || f.data.about_axis) return std::nullopt;
  const std::size_t axis = f.model.longest_axis();
  FieldData mirrored = f.data;
  for (Vec3& p : mirrored.at) component(p, axis) *= -1;
  FieldModel model(f.field, mirrored, f.centre.value_or(Vec3{}), {});
  const double other = solved(model, f.data.source).rms;
  if (!(other < 0.3 * residual)) return std::nullopt;
  return Warning{"axis", fmt::format("the {} axis of the table is reversed", "xyz"[axis]),
                 fmt::format("the residual is {:.2g} % of the field with -{} instead of {:.2g} %",
                             100 * other, "xyz"[axis], 100 * residual),
                 "change the sign of this column", Quality::poor};
}

}  // namespace

std::vector<Warning> field_warnings(const FittedField& f, FieldFit& result) {
  std::vector<Warning> out;
  const double residual = result.rms / result.rms_field;
  const auto add = [&](std::optional<Warning> w) {
    if (w) out.push_back(std::move(*w));
  };
  add(check_units(f, residual));
  if (residual > kLargeResidual)
    add(Warning{"residual", "the coil system does not describe the measured field",
                fmt::format("the residual is {:.0f} % of the field", 100 * residual),
                "check the columns, the units, outliers and that the coil system is the measured one",
                Quality::poor});
  else
    add(check_structure(f, residual));
  add(check_axis(f, residual));
  add(check_gain(result));
  add(check_saturation(f));
  const std::size_t kept = result.undetermined.size();
  add(check_size(f, result.t95, result.undetermined));
  const bool degenerate = f.fit.degenerate || result.undetermined.size() > kept;
  if (!result.undetermined.empty())
    add(Warning{
        "points", "the measured points do not determine all parameters",
        fmt::format("{} {} kept at the value in the coil system", fmt::join(result.undetermined, ", "),
                    result.undetermined.size() == 1 ? "is" : "are"),
        "measure at points off the axis, and at several distances from the coils",
        degenerate ? Quality::doubtful : Quality::good});
  return out;
}

}  // namespace faba
