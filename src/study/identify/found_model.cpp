#include "study/identify/found_model.h"

#include <fmt/format.h>

#include <Eigen/Dense>
#include <algorithm>
#include <cmath>
#include <numeric>
#include <string_view>

#include "core/error.h"
#include "core/random/distributions.h"
#include "core/statistics.h"
#include "study/identify/derived_seed.h"
#include "study/identify/experiment_bootstrap.h"
#include "study/identify/profile.h"
#include "study/stats/statistics.h"
#include "study/stats/study_random.h"

namespace faba {

using Eigen::Index;
using Eigen::MatrixXd;
using Eigen::VectorXd;

VectorXd noise_of(const ParameterSearch& s) {
  return (s.emulator().residuals().array().square().colwise().mean().sqrt().max(kStatisticResolution))
      .matrix()
      .transpose();
}

double energy_score(const MatrixXd& draws, const VectorXd& observed, const VectorXd& scale) {
  const MatrixXd x = draws * scale.cwiseInverse().asDiagonal();
  const VectorXd y = observed.cwiseQuotient(scale);
  double to_observed = 0, between_draws = 0;
  for (Index i = 0; i < x.rows(); ++i) {
    to_observed += (x.row(i).transpose() - y).norm();
    for (Index j = 0; j < i; ++j) between_draws += (x.row(i) - x.row(j)).norm();
  }
  const double m = double(x.rows());
  return (to_observed / m - between_draws / (m * (m - 1))) / std::sqrt(double(observed.size()));
}

namespace {

constexpr int kDraws = 1000;               // samples of a posterior
constexpr int kPredictions = 200;          // predictive samples of an experiment
constexpr double kLevel = 0.90;            // of the credible intervals
constexpr int kProfile = 41;               // points of a profile likelihood
constexpr double kUninformative = 0.75;    // fraction of the prior range; a uniform posterior has 0.9
constexpr double kMaxCorrelation = 0.9;    // above it two parameters are not identifiable separately
constexpr double kLimitTolerance = 0.005;  // fraction of the prior range

double weighted_quantile(const VectorXd& v, const VectorXd& weight, double p) {
  std::vector<Index> order(std::size_t(v.size()));
  std::iota(order.begin(), order.end(), Index(0));
  std::sort(order.begin(), order.end(), [&](Index a, Index b) { return v[a] < v[b]; });
  double sum = 0;
  for (const Index i : order)
    if ((sum += weight[i]) >= p) return v[i];
  return v[order.back()];
}

FoundParameter found(const FreeParameter& p, const VectorXd& u, const VectorXd& abc_u,
                     const VectorXd& abc_weight) {
  FoundParameter f{.parameter = p};
  for (const double x : u) f.draws.push_back(p.value(x));
  const double low = (1 - kLevel) / 2, high = 1 - low;
  const std::vector<double> fractions(u.begin(), u.end());
  f.median = p.value(median(fractions));
  f.ci90 = {p.value(quantile(fractions, low)), p.value(quantile(fractions, high))};
  f.fraction_of_range = quantile(fractions, high) - quantile(fractions, low);
  f.abc_median = p.value(weighted_quantile(abc_u, abc_weight, 0.5));
  f.abc_ci90 = {p.value(weighted_quantile(abc_u, abc_weight, low)),
                p.value(weighted_quantile(abc_u, abc_weight, high))};
  return f;
}

// Predictive samples of an experiment at parameters `u`: expected statistics plus the residuals of a
// simulation that is sampled at random.
MatrixXd predict(const ParameterSearch& s, const MatrixXd& u, const std::vector<Index>& columns,
                 StudyRandom& random) {
  const MatrixXd& residuals = s.emulator().residuals();
  MatrixXd x(u.rows(), Index(columns.size()));
  for (Index i = 0; i < u.rows(); ++i) {
    const VectorXd mean = s.emulator().mean(u.row(i).transpose());
    const Index row = Index(random.below(std::size_t(residuals.rows())));
    for (std::size_t k = 0; k < columns.size(); ++k)
      x(i, Index(k)) = mean[columns[k]] + residuals(row, columns[k]);
  }
  return x;
}

// Warning about a limit of the prior range that the posterior reaches, unless it is a limit of the parameter
// itself; empty for none.
std::string range_limit_warning(const FoundParameter& p) {
  const FreeParameter& q = p.parameter;
  const double low = q.fraction(p.ci90[0]), high = q.fraction(p.ci90[1]);
  const auto warning = [&](const char* which, double value) {
    return fmt::format(
        "the 90 % interval of {} reaches the {} limit of its prior range, {:.3g}{}{}: repeat with a wider "
        "range",
        q.path, which, q.shown(value), q.shown_unit().empty() ? "" : " ", q.shown_unit());
  };
  if (!q.low_is_limit && low < kLimitTolerance) return warning("lower", q.low);
  if (!q.high_is_limit && high > 1 - kLimitTolerance) return warning("upper", q.high);
  return {};
}

void add_doubt(FoundParameter& p, const std::string& doubt) {
  if (!doubt.empty()) p.doubt += (p.doubt.empty() ? "" : "; ") + doubt;
}

// `parts`: "experiments", or "field segments" when the videos belong to one experiment.
void add_doubts(FoundModel& m, const MatrixXd& draws, const char* parts) {
  const MatrixXd off = draws.rowwise() - draws.colwise().mean();
  for (Index j = 0; j < draws.cols(); ++j) {
    FoundParameter& p = m.parameters[std::size_t(j)];
    if (p.fraction_of_range > kUninformative) {
      p.doubt = fmt::format(
          "{} is not identifiable from these videos: its 90 % interval covers {:.0f} % of the prior range",
          p.parameter.path, 100 * p.fraction_of_range);
      continue;
    }
    for (Index k = 0; k < draws.cols(); ++k) {
      const double r = off.col(j).dot(off.col(k)) / (off.col(j).norm() * off.col(k).norm());
      // The interval contains the uncertainty of a nuisance parameter already.
      const bool both = p.parameter.nuisance() == m.parameters[std::size_t(k)].parameter.nuisance();
      if (k != j && both && std::fabs(r) > kMaxCorrelation)
        p.doubt = fmt::format("{} and {} are not identifiable separately: posterior correlation {:.2f}",
                              p.parameter.path, m.parameters[std::size_t(k)].parameter.path, r);
    }
    const FreeParameter& q = p.parameter;
    add_doubt(p, range_limit_warning(p));
    if (p.abc_ci90[0] > p.ci90[1] || p.abc_ci90[1] < p.ci90[0])
      add_doubt(p, fmt::format("the 90 % intervals of {} from the synthetic likelihood and from approximate "
                               "Bayesian computation do not overlap: neither is reliable",
                               q.path));
    // The field segments of one swarm determine a parameter unequally, which makes their bootstrap wide.
    const bool differ = p.resampled90 && std::string_view(parts) == "experiments" &&
                        experiments_differ(*p.resampled90, p.ci90);
    if (p.doubt.empty() && differ)
      p.doubt = fmt::format(
          "{} differs between {} by more than the model predicts: the 90 % bootstrap interval over {} is "
          "{:.3g} to {:.3g}{}{}",
          q.path, parts, parts, q.shown((*p.resampled90)[0]), q.shown((*p.resampled90)[1]),
          q.shown_unit().empty() ? "" : " ", q.shown_unit());
  }
}

// Fraction of simulations whose squared distance from the expected statistics, in units of the noise, is at
// least that of the observation.
double fit_p(const ParameterSearch& s, const VectorXd& mode, const VectorXd& observed) {
  const MatrixXd& residuals = s.emulator().residuals();
  const VectorXd scale = noise_of(s);
  const auto squared_distance = [&](const VectorXd& off) { return off.cwiseQuotient(scale).squaredNorm(); };
  const double distance = squared_distance(observed - s.emulator().mean(mode));
  double further = 0;
  for (Index i = 0; i < residuals.rows(); ++i)
    further += squared_distance(residuals.row(i).transpose()) >= distance;
  return (further + 1) / double(residuals.rows() + 1);
}

// Whether the posterior lies where simulations are near the observation. Distances are in units of the noise
// over all simulations, which a posterior in a wrong region does not distort.
bool converged(const ParameterSearch& s, const VectorXd& mode) {
  constexpr double kMuchNearer = 0.1;
  const SimulationTable& all = s.simulations();
  const Eigen::RowVectorXd mean = all.s.colwise().mean();
  const VectorXd scale = (all.s.rowwise() - mean)
                             .array()
                             .square()
                             .colwise()
                             .mean()
                             .sqrt()
                             .max(kStatisticResolution)
                             .matrix()
                             .transpose();
  const auto squared_distance = [&](const VectorXd& off) { return off.cwiseQuotient(scale).squaredNorm(); };
  double nearest = squared_distance(all.s.row(0).transpose() - s.observed());
  for (Index i = 1; i < all.size(); ++i)
    nearest = std::min(nearest, squared_distance(all.s.row(i).transpose() - s.observed()));
  return nearest > kMuchNearer * squared_distance(s.emulator().mean(mode) - s.observed());
}

}  // namespace

ScoredModel found_model(const Candidate& candidate, const ParameterSearch& s,
                        const std::vector<std::vector<Index>>& experiments, const char* parts,
                        const VectorXd& scale, std::uint64_t seed) {
  ScoredModel scored;
  FoundModel& m = scored.model;
  const MatrixXd draws = s.posterior({}, kDraws, seed);
  const auto abc = s.abc_posterior();
  VectorXd middle(draws.cols());
  for (Index j = 0; j < draws.cols(); ++j) {
    const FreeParameter& p = candidate.free[std::size_t(j)];
    m.parameters.push_back(found(p, draws.col(j), abc.u.col(j), abc.weight));
    middle[j] = median(std::vector<double>(draws.col(j).begin(), draws.col(j).end()));
    m.best[p.path] = p.json(middle[j]);
  }
  VectorXd sd(draws.cols());
  for (Index j = 0; j < draws.cols(); ++j)
    sd[j] = sample_sd({draws.col(j).data(), std::size_t(draws.rows())});
  const auto resampled = resampled_estimates(s, experiments, middle, sd, seed);
  for (std::size_t j = 0; j < resampled.size(); ++j) {
    const FreeParameter& p = m.parameters[j].parameter;
    m.parameters[j].resampled90 = {p.value(resampled[j][0]), p.value(resampled[j][1])};
  }
  add_doubts(m, draws, parts);
  const SyntheticLikelihood l = s.likelihood({});
  for (Index j = 0; j < draws.cols(); ++j) {
    FoundParameter& p = m.parameters[std::size_t(j)];
    const Profile profile = profile_likelihood([&](const VectorXd& u) { return l.log_likelihood(u); },
                                               s.box(), middle, j, kProfile);
    Index best = 0, from, to;
    profile.log_likelihood.maxCoeff(&best);
    // A profile that rises again far from its maximum is an artefact of the emulator's polynomial: cut it.
    for (from = best; from > 0 && profile.log_likelihood[from - 1] <= profile.log_likelihood[from];) --from;
    for (to = best;
         to + 1 < profile.u.size() && profile.log_likelihood[to + 1] <= profile.log_likelihood[to];)
      ++to;
    for (Index k = from; k <= to; ++k) {
      p.profile_at.push_back(p.parameter.value(profile.u[k]));
      p.profile.push_back(profile.log_likelihood[k]);
    }
  }
  m.simulations = std::size_t(s.simulations().size());
  m.rounds = s.rounds();
  m.fit_p = fit_p(s, middle, s.observed());
  m.converged = converged(s, middle);
  const VectorXd mean = s.emulator().mean(middle), noise = noise_of(s);
  m.predicted.assign(mean.begin(), mean.end());
  m.predicted_sd.assign(noise.begin(), noise.end());
  StudyRandom random(seed, StudyDraws::prediction);
  for (std::size_t e = 0; e < experiments.size(); ++e) {
    MatrixXd u = draws.topRows(kPredictions);
    if (experiments.size() > 1) {
      std::vector<Index> others;
      for (std::size_t k = 0; k < experiments.size(); ++k)
        if (k != e) others.insert(others.end(), experiments[k].begin(), experiments[k].end());
      std::sort(others.begin(), others.end());
      u = s.posterior(others, kPredictions, derived_seed(seed, SeedUse::left_out, e));
    }
    const auto& columns = experiments[e];
    scored.samples.push_back(predict(s, u, columns, random));
    m.scores.push_back(energy_score(scored.samples.back(), s.observed()(columns), scale(columns)));
    m.score += m.scores.back() / double(experiments.size());
  }
  return scored;
}

}  // namespace faba
