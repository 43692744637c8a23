#include "study/pages/calibration/calibration_figures.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "core/random/distributions.h"

namespace faba {
namespace {

constexpr int kLevels = 50;  // of a curve of coverage
constexpr double kBand = 0.99;

std::string axis_label(const FreeParameter& p, const char* what) {
  const std::string unit = p.shown_unit();
  return fmt::format("{} {}{}", what, p.name(), unit.empty() ? "" : " (" + unit + ")");
}

Plot inlined_plot(const std::string& description) {
  Plot p;
  p.description = description;
  p.inlined = true;
  return p;
}

// The line of equal values.
Line diagonal(double lo, double hi) {
  return {.x = {lo, hi}, .y = {lo, hi}, .label = {}, .ink = Ink::muted, .dashed = true};
}

}  // namespace

Figure rank_figure(const ModelCalibration& m, const ParameterCalibration& p) {
  const RankHistogram& h = p.ranks;
  Figure f{
      fmt::format("{}: ranks of {}", m.name, p.parameter.path),
      fmt::format("Number of experiments by the fraction of the posterior below the true value; flat for "
                  "calibrated intervals. Shaded: 99 % band of all bins together ({} to {}). Chi-square "
                  "test of flatness: p = {:.2g}.",
                  h.low, h.high, h.p),
      inlined_plot("Rank histogram of " + p.parameter.path)};
  f.plot.x.label = "rank of the true value (fraction)";
  f.plot.y.label = "experiments";
  f.plot.x.lo = 0;
  f.plot.x.hi = 1;
  f.plot.y.lo = 0;
  const double bins = double(h.counts.size());
  Line steps{.x = {}, .y = {}, .label = {}, .ink = Ink::blue, .stairs = true};
  for (std::size_t k = 0; k <= h.counts.size(); ++k) {
    steps.x.push_back(double(k) / bins);
    steps.y.push_back(h.counts[std::min(k, h.counts.size() - 1)]);
  }
  f.plot.add(Band{double(h.low), double(h.high), {}, false});
  f.plot.add(Rule{.at = h.expected, .label = {}, .of_x = false});
  f.plot.add(std::move(steps));
  return f;
}

Figure truth_figure(const ModelCalibration& m, const ParameterCalibration& p) {
  const FreeParameter& q = p.parameter;
  Figure f{fmt::format("{}: estimates of {}", m.name, q.path),
           "Posterior median and 90 % interval of each experiment over the true value.",
           inlined_plot("Estimates of " + q.path + " over the true values")};
  f.plot.x.label = axis_label(q, "true");
  f.plot.y.label = axis_label(q, "estimated");
  ErrorBars bars{.x = {}, .lo = {}, .hi = {}, .label = {}, .ink = Ink::sky};
  Scatter dots{.x = {}, .y = {}, .label = {}, .ink = Ink::blue, .size = 3};
  for (const CalibratedEstimate& e : p.estimates) {
    bars.x.push_back(q.shown(e.truth));
    bars.lo.push_back(q.shown(e.low90));
    bars.hi.push_back(q.shown(e.high90));
    dots.x.push_back(q.shown(e.truth));
    dots.y.push_back(q.shown(e.median));
  }
  f.plot.add(std::move(bars)).add(diagonal(q.shown(q.low), q.shown(q.high))).add(std::move(dots));
  return f;
}

Figure coverage_figure(const ModelCalibration& m) {
  Figure f{
      m.name + ": coverage of the intervals",
      "Fraction of the experiments whose central interval contains the true value, over the level of the "
      "interval. Shaded: 99 % band of calibrated intervals (binomial, at each level).",
      inlined_plot("Coverage of the intervals of " + m.name)};
  f.plot.x.label = "level of the interval";
  f.plot.y.label = "fraction that contains the truth";
  f.plot.x.lo = f.plot.y.lo = 0;
  f.plot.x.hi = f.plot.y.hi = 1;
  Ribbon band{.x = {}, .lo = {}, .hi = {}, .label = {}, .ink = Ink::muted};
  std::vector<double> levels;
  for (int k = 0; k <= kLevels; ++k) levels.push_back(double(k) / kLevels);
  for (const double level : levels) {
    const BinomialRange r = binomial_range(m.experiments, level, kBand);
    band.x.push_back(level);
    band.lo.push_back(double(r.low) / m.experiments);
    band.hi.push_back(double(r.high) / m.experiments);
  }
  f.plot.add(std::move(band)).add(diagonal(0, 1));
  for (const ParameterCalibration& p : m.parameters) {
    Line curve{.x = levels, .y = {}, .label = p.parameter.name()};
    curve.dashed = p.parameter.nuisance();
    for (const double level : levels) {
      const auto inside =
          std::count_if(p.estimates.begin(), p.estimates.end(),
                        [&](const CalibratedEstimate& e) { return std::fabs(e.rank - 0.5) <= 0.5 * level; });
      curve.y.push_back(double(inside) / m.experiments);
    }
    f.plot.add(std::move(curve));
  }
  return f;
}

Figure tarp_figure(const ModelCalibration& m) {
  Figure f{
      m.name + ": all parameters together (TARP)",
      fmt::format("Expected coverage of regions around random points (TARP, Lemos et al. 2023). Shaded: "
                  "99 % band (binomial, at each level). Largest difference {:.3f} (Kolmogorov-Smirnov p = "
                  "{:.2g}).",
                  m.tarp.largest, m.tarp.p),
      inlined_plot("Expected coverage of all parameters of " + m.name)};
  f.plot.x.label = "credibility level";
  f.plot.y.label = "expected coverage";
  f.plot.x.lo = f.plot.y.lo = 0;
  f.plot.x.hi = f.plot.y.hi = 1;
  f.plot.add(Ribbon{.x = m.tarp.at, .lo = m.tarp.low, .hi = m.tarp.high, .label = {}, .ink = Ink::muted});
  f.plot.add(diagonal(0, 1));
  f.plot.add(Line{.x = m.tarp.at, .y = m.tarp.fraction, .label = {}, .ink = Ink::blue});
  return f;
}

}  // namespace faba
