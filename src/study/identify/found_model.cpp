#include "study/identify/found_model.h"

#include <fmt/format.h>

#include <Eigen/Dense>
#include <algorithm>
#include <cmath>
#include <numeric>

#include "core/distributions.h"
#include "core/error.h"
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
  // Whatever a statistic is of, pixels per frame or a share, a hundredth is below what videos tell.
  return (s.emulator().residuals().array().square().colwise().mean().sqrt().max(0.01)).matrix().transpose();
}

namespace {

constexpr int kDraws = 1000;        // from a posterior
constexpr int kPredictions = 200;   // of what an experiment will show
constexpr double kLevel = 0.90;     // of the intervals
constexpr int kProfile = 41;        // values of each parameter
constexpr double kUnlearnt = 0.75;  // share of the range: 0.9 when nothing was learnt
constexpr double kTogether = 0.9;   // correlation from which on two are one
constexpr double kAtEnd = 0.005;    // of the range, from its end
constexpr double kDiffer = 2;  // times the posterior's width: by chance three sd off for four experiments

double weighed_quantile(const VectorXd& v, const VectorXd& weight, double p) {
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
  const std::vector<double> shares(u.begin(), u.end());
  f.median = p.value(median(shares));
  f.ci90 = {p.value(quantile(shares, low)), p.value(quantile(shares, high))};
  f.fraction_of_range = quantile(shares, high) - quantile(shares, low);
  f.abc_median = p.value(weighed_quantile(abc_u, abc_weight, 0.5));
  f.abc_ci90 = {p.value(weighed_quantile(abc_u, abc_weight, low)),
                p.value(weighed_quantile(abc_u, abc_weight, high))};
  return f;
}

/// Energy score of draws (rows) for what came, in units of `scale`; divided by the square root of how many
/// numbers there are, so that experiments of different length count alike.
double energy_score(const MatrixXd& draws, const VectorXd& came, const VectorXd& scale) {
  const MatrixXd x = draws * scale.cwiseInverse().asDiagonal();
  const VectorXd y = came.cwiseQuotient(scale);
  double to = 0, among = 0;
  for (Index i = 0; i < x.rows(); ++i) {
    to += (x.row(i).transpose() - y).norm();
    for (Index j = 0; j < i; ++j) among += (x.row(i) - x.row(j)).norm();
  }
  const double m = double(x.rows());
  return (to / m - among / (m * (m - 1))) / std::sqrt(double(came.size()));
}

// What an experiment would show at parameters drawn from the others' posterior: the expected numbers, and
// what is left over of a simulation.
MatrixXd predict(const ParameterSearch& s, const MatrixXd& u, const std::vector<Index>& columns,
                 StudyRandom& random) {
  const MatrixXd& left = s.emulator().residuals();
  MatrixXd x(u.rows(), Index(columns.size()));
  for (Index i = 0; i < u.rows(); ++i) {
    const VectorXd mean = s.emulator().mean(u.row(i).transpose());
    const Index other = Index(random.below(std::size_t(left.rows())));
    for (std::size_t k = 0; k < columns.size(); ++k)
      x(i, Index(k)) = mean[columns[k]] + left(other, columns[k]);
  }
  return x;
}

// The end of its range that the posterior leans on, unless nothing lies beyond it; empty for neither.
std::string leans_on(const FoundParameter& p) {
  const FreeParameter& q = p.parameter;
  const double low = q.share(p.ci90[0]), high = q.share(p.ci90[1]);
  const auto said = [&](const char* which, double value) {
    return fmt::format(
        "{} lies at the {} end of its range, {:.3g}{}{}: a wider range may give another answer", q.path,
        which, q.shown(value), q.shown_unit().empty() ? "" : " ", q.shown_unit());
  };
  if (!q.low_is_least && low < kAtEnd) return said("lower", q.low);
  if (!q.high_is_most && high > 1 - kAtEnd) return said("upper", q.high);
  return {};
}

void add_doubt(FoundParameter& p, const std::string& doubt) {
  if (!doubt.empty()) p.doubt += (p.doubt.empty() ? "" : "; ") + doubt;
}

void tell_doubts(FoundModel& m, const MatrixXd& draws) {
  const MatrixXd off = draws.rowwise() - draws.colwise().mean();
  for (Index j = 0; j < draws.cols(); ++j) {
    FoundParameter& p = m.parameters[std::size_t(j)];
    if (p.fraction_of_range > kUnlearnt) {
      p.doubt = fmt::format(
          "{} cannot be found from these videos: 90 % of the posterior cover {:.0f} % of its range",
          p.parameter.path, 100 * p.fraction_of_range);
      continue;
    }
    for (Index k = 0; k < draws.cols(); ++k) {
      const double r = off.col(j).dot(off.col(k)) / (off.col(j).norm() * off.col(k).norm());
      if (k != j && std::fabs(r) > kTogether)
        p.doubt =
            fmt::format("{} is found together with {} only: one makes up for the other (correlation {:.2f})",
                        p.parameter.path, m.parameters[std::size_t(k)].parameter.path, r);
    }
    const FreeParameter& q = p.parameter;
    add_doubt(p, leans_on(p));
    if (p.abc_ci90[0] > p.ci90[1] || p.abc_ci90[1] < p.ci90[0])
      add_doubt(p, fmt::format("approximate Bayesian computation puts {} elsewhere: trust neither", q.path));
    const bool differ =
        p.resampled90 && ((*p.resampled90)[1] - (*p.resampled90)[0] > kDiffer * (p.ci90[1] - p.ci90[0]) ||
                          p.median < (*p.resampled90)[0] || p.median > (*p.resampled90)[1]);
    if (p.doubt.empty() && differ)
      p.doubt = fmt::format(
          "experiments differ about {} by more than the model knows of: of experiments drawn anew, 90 % give "
          "{:.3g} to {:.3g}{}{}",
          q.path, q.shown((*p.resampled90)[0]), q.shown((*p.resampled90)[1]),
          q.shown_unit().empty() ? "" : " ", q.shown_unit());
  }
}

// How far from its own mean a simulation is, by all numbers together; as a share of simulations that are
// further.
double fit_p(const ParameterSearch& s, const VectorXd& mode, const VectorXd& observed) {
  const MatrixXd& left = s.emulator().residuals();
  const VectorXd scale = noise_of(s);
  const auto far = [&](const VectorXd& off) { return off.cwiseQuotient(scale).squaredNorm(); };
  const double here = far(observed - s.emulator().mean(mode));
  double further = 0;
  for (Index i = 0; i < left.rows(); ++i) further += far(left.row(i).transpose()) >= here;
  return (further + 1) / double(left.rows() + 1);
}

}  // namespace

FoundModel found_model(const Candidate& candidate, const ParameterSearch& s,
                       const std::vector<std::vector<Index>>& experiments, const VectorXd& scale,
                       std::uint64_t seed) {
  FoundModel m;
  const MatrixXd draws = s.posterior({}, kDraws, seed);
  const auto abc = s.by_distance();
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
  tell_doubts(m, draws);
  const SyntheticLikelihood l = s.likelihood({});
  for (Index j = 0; j < draws.cols(); ++j) {
    FoundParameter& p = m.parameters[std::size_t(j)];
    const Profile profile = profile_likelihood([&](const VectorXd& u) { return l.log_likelihood(u); },
                                               s.box(), middle, j, kProfile);
    Index best = 0, from, to;
    profile.log_likelihood.maxCoeff(&best);
    // Where it rises again the emulator's parabola has turned, far from all simulations.
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
  m.fit_p = fit_p(s, middle, s.observed());
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
    m.scores.push_back(energy_score(predict(s, u, columns, random), s.observed()(columns), scale(columns)));
    m.score += m.scores.back() / double(experiments.size());
  }
  return m;
}

void judge(Identification& r) {
  std::vector<std::size_t> order;
  for (std::size_t i = 0; i < r.models.size(); ++i)
    if (r.models[i].failed.empty()) order.push_back(i);
  if (order.empty()) throw Error(Errc::input, r.study.title, r.models.front().failed);
  std::sort(order.begin(), order.end(),
            [&](auto a, auto b) { return r.models[a].score < r.models[b].score; });
  r.best = order[0];
  const FoundModel& best = r.models[r.best];
  r.evidence = "none";
  const std::string poor = best.fit_p < 0.01 ? fmt::format(
                                                   " None of them explains the videos: only {:.1g} % of the "
                                                   "simulations of {} are as far from their mean.",
                                                   100 * best.fit_p, best.name)
                                             : "";
  if (order.size() < 2) {
    r.words = "One model only: there is nothing to compare it with." + poor;
    return;
  }
  const FoundModel& next = r.models[order[1]];
  const double n = double(best.scores.size());
  std::vector<double> lead;
  for (std::size_t e = 0; e < best.scores.size(); ++e) lead.push_back(next.scores[e] - best.scores[e]);
  for (const double x : lead) r.ahead += x / n;
  if (n < 2) {
    r.words =
        fmt::format("No evidence either way: one experiment cannot predict another. {} is nearer than {}.",
                    best.name, next.name) +
        poor;
    return;
  }
  const double se = sample_sd(lead) / std::sqrt(n), half = student_t_quantile(0.975, n - 1) * se;
  r.ahead_ci95 = {r.ahead - half, r.ahead + half};
  r.evidence = r.ahead - half > 0 ? "clear" : r.ahead > se ? "weak" : "none";
  // Of models that predict equally well the one with the fewest parameters will do.
  std::string simpler;
  if (r.evidence == "none" && next.parameters.size() < best.parameters.size()) {
    r.best = order[1];
    simpler = fmt::format(" {} has fewer parameters and will do.", next.name);
  }
  const std::string lead_words =
      fmt::format("its energy score is {:.3g} less per experiment, 95 % {:.3g} to {:.3g}", r.ahead,
                  (*r.ahead_ci95)[0], (*r.ahead_ci95)[1]);
  r.words = (r.evidence == "clear" ? fmt::format("{} predicts experiments better than {}: {}.", best.name,
                                                 next.name, lead_words)
             : r.evidence == "weak"
                 ? fmt::format("Weak evidence for {} over {}: {}.", best.name, next.name, lead_words)
                 : fmt::format("No evidence either way between {} and {}: {}.{}", best.name, next.name,
                               lead_words, simpler)) +
            poor;
}

}  // namespace faba
