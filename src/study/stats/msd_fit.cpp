#include "study/stats/msd_fit.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <set>

namespace faba {
namespace {

// Weight of a lag: from its standard error, or from the error for independent pairs when that is unknown.
double weight_of(const Msd& m, std::size_t k) {
  if (m.se_px2[k] > 0) return 1 / (m.se_px2[k] * m.se_px2[k]);
  return m.pairs[k] / std::max(m.msd_px2[k] * m.msd_px2[k], 1e-300);
}

// y = a x + b.
struct StraightLine {
  double slope = 0, offset = 0;
};
StraightLine straight_line(const std::vector<double>& x, const std::vector<double>& y,
                           const std::vector<double>& w) {
  double s = 0, sx = 0, sy = 0, sxx = 0, sxy = 0;
  for (std::size_t i = 0; i < x.size(); ++i) {
    s += w[i];
    sx += w[i] * x[i];
    sy += w[i] * y[i];
    sxx += w[i] * x[i] * x[i];
    sxy += w[i] * x[i] * y[i];
  }
  const double det = s * sxx - sx * sx;
  if (!(det > 0)) return {0, sy / s};
  return {(s * sxy - sx * sy) / det, (sxx * sy - sx * sxy) / det};
}

// 2 tau^2 (x - 1 + exp(-x)), x = t / tau; by its series where x is small, to avoid cancellation.
double persistent_shape(double t, double tau) {
  const double x = t / tau;
  if (x < 1e-3) return t * t * (1 - x / 3 + x * x / 12);
  return 2 * tau * tau * (x - 1 + std::exp(-x));
}

struct Linear {
  double v2 = 0, offset = 0, chi2 = std::numeric_limits<double>::infinity();
};
// `w`: weights; `g`: takes the shape.
Linear solve_for(const Msd& m, double tau, const std::vector<double>& w, std::vector<double>& g) {
  for (std::size_t k = 0; k < m.size(); ++k) g[k] = persistent_shape(m.lag_s[k], tau);
  Linear out;
  const StraightLine both = straight_line(g, m.msd_px2, w);
  out.v2 = both.slope;
  out.offset = both.offset;
  if (out.offset < 0 || out.v2 < 0) {
    double gg = 0, gy = 0;
    for (std::size_t k = 0; k < g.size(); ++k) {
      gg += w[k] * g[k] * g[k];
      gy += w[k] * g[k] * m.msd_px2[k];
    }
    out.v2 = std::max(0.0, gy / gg);
    out.offset = 0;
  }
  out.chi2 = 0;
  for (std::size_t k = 0; k < g.size(); ++k) {
    const double off = m.msd_px2[k] - out.v2 * g[k] - out.offset;
    out.chi2 += w[k] * off * off;
  }
  return out;
}

}  // namespace

DiffusionFit fit_diffusion(const Msd& m, std::size_t first, std::size_t lags) {
  DiffusionFit fit;
  const std::size_t all = m.size() > first ? m.size() - first : 0;
  if (all < 2) return first > 0 ? fit_diffusion(m, 0, lags) : fit;
  const std::size_t least = first > 0 ? 4 : 2;
  std::size_t use = lags > 0 ? lags : 4;
  for (int round = 0; round < 10; ++round) {
    use = std::min(std::max(use, least), all);
    std::vector<double> x, y, w;
    for (std::size_t k = first; k < first + use; ++k) {
      x.push_back(m.lag_s[k]);
      y.push_back(m.msd_px2[k]);
      w.push_back(weight_of(m, k));
    }
    const StraightLine line = straight_line(x, y, w);
    fit = {true, line.slope / 4, line.offset, first, use};
    if (lags > 0 || !(line.slope > 0)) break;
    // Ratio of the localisation error to the displacement of one frame.
    const double ratio = std::max(0.0, line.offset / 4) / (fit.d_px2_s * m.lag_s[0]);
    const auto best = std::max(least, std::size_t(std::floor(2 + 2.3 * std::pow(ratio, 0.52))));
    if (best == use) break;
    use = best;
  }
  return fit;
}

PersistentFit fit_persistent(const Msd& m) {
  PersistentFit fit;
  if (m.size() < 4) return fit;
  const double least = 0.2 * m.lag_s.front(), most = 20 * m.lag_s.back();
  constexpr int kSteps = 400;
  std::vector<double> weights, shape(m.size());
  for (std::size_t k = 0; k < m.size(); ++k) weights.push_back(weight_of(m, k));
  Linear best;
  int at = 0;
  for (int i = 0; i <= kSteps; ++i) {
    const double tau = least * std::pow(most / least, double(i) / kSteps);
    const Linear l = solve_for(m, tau, weights, shape);
    if (l.chi2 < best.chi2) {
      best = l;
      fit.tau_s = tau;
      at = i;
    }
  }
  fit.good = best.v2 > 0 && at > 0;  // not determined at the shortest time of the search
  fit.speed_px_s = std::sqrt(std::max(0.0, best.v2));
  fit.offset_px2 = best.offset;
  fit.tau_open = at == kSteps || fit.tau_s > 5 * m.lag_s.back();
  return fit;
}

double fit_exponent(const Msd& m, double offset, std::size_t first) {
  std::vector<double> x, y, w;
  const double subtracted = std::max(0.0, offset);
  for (std::size_t k = first; k < m.size(); ++k) {
    const double left = m.msd_px2[k] - offset;
    if (!(left > subtracted) || !(left > 0)) continue;
    x.push_back(std::log(m.lag_s[k]));
    y.push_back(std::log(left));
    w.push_back(weight_of(m, k) * left * left);
  }
  if (x.size() < 3) return std::numeric_limits<double>::quiet_NaN();
  return straight_line(x, y, w).slope;
}

double jackknife_se(const std::vector<double>& v) {
  if (v.size() < 4) return std::numeric_limits<double>::quiet_NaN();
  double mean = 0, square = 0;
  for (const double x : v) mean += x / double(v.size());
  for (const double x : v) square += (x - mean) * (x - mean);
  return std::sqrt(square * double(v.size() - 1) / double(v.size()));
}

std::size_t last_compared(const Msd& m, const DiffusionFit& f) {
  constexpr double kBeyond = 4;
  if (m.size() == 0) return 0;
  std::size_t last = std::min(f.first + std::max<std::size_t>(1, f.lags), m.size()) - 1;
  const double most = kBeyond * m.lag_s[last];
  while (last + 1 < m.size() && m.lag_s[last + 1] <= most) ++last;
  return last;
}

MsdMisfit msd_misfit(const FittedMsd& all, const std::vector<FittedMsd>& left_out, std::size_t first,
                     std::size_t last) {
  constexpr int kCompared = 6;
  constexpr double kMatters = 0.1;
  // Two-sided quantile of Student's t with 19 degrees of freedom for a chance of 1 % over six comparisons.
  constexpr double kStudent = 3.66;
  std::set<std::size_t> compared;
  for (int i = 0; i < kCompared && last < all.msd.size() && first <= last; ++i)
    compared.insert(std::size_t(std::lround(
        double(first + 1) * std::pow(double(last + 1) / double(first + 1), double(i) / (kCompared - 1)) -
        1)));
  const auto deviation = [](const FittedMsd& f, std::size_t k) {
    return f.msd.msd_px2[k] / f.law_px2[k] - 1;
  };
  MsdMisfit worst;
  double clearest = 0;
  for (const std::size_t k : compared) {
    if (!(all.law_px2[k] > 0)) continue;
    std::vector<double> others;
    for (const FittedMsd& f : left_out)
      if (k < f.msd.size() && f.law_px2[k] > 0) others.push_back(deviation(f, k));
    const MsdMisfit m{all.msd.lag_s[k], deviation(all, k), jackknife_se(others), false};
    const double size = std::fabs(m.deviation);
    // Among significant deviations the largest, else the clearest.
    const bool significant = size > kMatters && size > kStudent * m.se;
    const double clear = significant ? 1e6 * (1 + size) : m.se > 0 ? size / m.se : 0;
    if (clear < clearest) continue;
    clearest = clear;
    worst = m;
    worst.significant = significant;
  }
  return worst;
}

double diffusion_msd(const DiffusionFit& f, double t) { return 4 * f.d_px2_s * t + f.offset_px2; }
double persistent_msd(const PersistentFit& f, double t) {
  return f.speed_px_s * f.speed_px_s * persistent_shape(t, f.tau_s) + f.offset_px2;
}

}  // namespace faba
