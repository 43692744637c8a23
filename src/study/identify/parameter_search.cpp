#include "study/identify/parameter_search.h"

#include <fmt/format.h>

#include <Eigen/Dense>
#include <algorithm>
#include <cmath>
#include <numbers>
#include <numeric>

#include "core/error.h"
#include "core/statistics.h"
#include "study/identify/derived_seed.h"
#include "study/stats/statistics.h"
#include "study/stats/study_random.h"

namespace faba {
namespace {

using Eigen::Index;
using Eigen::MatrixXd;
using Eigen::VectorXd;

constexpr double kNearFraction = 0.2;  // of the simulations: centres of the next proposal
constexpr double kWider = 1.8;         // sd of the last round over sd of the posterior
constexpr double kMaxSquare = 25;      // limit of a squared difference of a statistic, in robust sd
constexpr double kAbcFraction = 0.25;  // of the simulations since the second round: accepted by ABC
constexpr std::size_t kMostLast = 3;   // last rounds, at most
// Rounds before the last one: over the full ranges, then around the nearest simulations. With more parameters
// the region has to be narrowed once more before a quadratic function describes it.
constexpr int kFewParameters = 3;
std::size_t narrowing_rounds(int d) { return d > kFewParameters ? 4 : 3; }
// With more parameters the first of the last rounds is wide, and too few of its simulations are near the
// posterior.
std::size_t least_last_rounds(int d) { return d > kFewParameters ? 2 : 1; }
constexpr double kMaxAtLimit = 0.01;  // fraction of the posterior at a limit of the last round
constexpr int kProposalDraws = 400;   // posterior samples that define the last round

/// Low-discrepancy points in the unit cube: Kronecker sequence with the powers of the root of x^(d+1) = x +
/// 1, which generalises the golden ratio.
MatrixXd kronecker_points(Index n, Index d) {
  double root = 2;
  for (int i = 0; i < 60; ++i) root = std::pow(1 + root, 1.0 / double(d + 1));
  MatrixXd u(n, d);
  for (Index j = 0; j < d; ++j) {
    const double step = std::pow(1 / root, double(j + 1));
    for (Index i = 0; i < n; ++i) {
      const double x = 0.5 + double(i + 1) * step;
      u(i, j) = x - std::floor(x);
    }
  }
  return u;
}

/// Columns relative to their median, in robust standard deviations; a constant column becomes 0.
struct Standard {
  VectorXd middle, scale;
  explicit Standard(const MatrixXd& s) : middle(s.cols()), scale(s.cols()) {
    for (Index j = 0; j < s.cols(); ++j) {
      const RobustSpread<double> robust =
          robust_spread(std::vector<double>(s.col(j).begin(), s.col(j).end()));
      middle[j] = robust.median;
      double spread = robust.sd;
      if (!(spread > 0)) spread = std::sqrt((s.col(j).array() - s.col(j).mean()).square().mean());
      scale[j] = spread > 1e-12 ? 1 / spread : 0;
    }
  }
  MatrixXd operator()(const MatrixXd& s) const {
    return ((s.rowwise() - middle.transpose()) * scale.asDiagonal()).cwiseMax(-10).cwiseMin(10);
  }
};

MatrixXd covariance_of(const MatrixXd& u) {
  const MatrixXd off = u.rowwise() - u.colwise().mean();
  return off.transpose() * off / std::max(1.0, double(u.rows() - 1));
}

std::vector<Index> smallest(const VectorXd& value, Index count) {
  std::vector<Index> order(std::size_t(value.size()));
  std::iota(order.begin(), order.end(), Index(0));
  std::stable_sort(order.begin(), order.end(), [&](Index a, Index b) { return value[a] < value[b]; });
  order.resize(std::size_t(std::min(count, value.size())));
  return order;
}

std::vector<Index> all_columns(Index n) {
  std::vector<Index> v(static_cast<std::size_t>(n));
  std::iota(v.begin(), v.end(), Index(0));
  return v;
}

}  // namespace

SearchRounds SearchRounds::of(int simulations) {
  const SearchRounds defaults;
  SearchRounds r;
  r.first = simulations * defaults.first / defaults.total();
  r.refinement = simulations * defaults.refinement / defaults.total();
  r.last = simulations - r.first - 2 * r.refinement;
  return r;
}

double ParameterSearch::Proposal::density(const VectorXd& u) const {
  if (centres.rows() == 0) return 1;
  const Eigen::LLT<MatrixXd> root(covariance);
  double sum = 0;
  for (Index i = 0; i < centres.rows(); ++i) {
    const VectorXd z = root.matrixL().solve(u - centres.row(i).transpose());
    sum += std::exp(-0.5 * z.squaredNorm());
  }
  const double volume =
      MatrixXd(root.matrixL()).diagonal().prod() * std::pow(2 * std::numbers::pi, 0.5 * double(u.size()));
  return sum / (double(centres.rows()) * volume);
}

ParameterSearch::ParameterSearch(int d, VectorXd observed, LogPrior log_prior, SearchRounds rounds,
                                 std::uint64_t seed)
    : d_(d),
      narrowing_(narrowing_rounds(d)),
      observed_(std::move(observed)),
      log_prior_(std::move(log_prior)),
      rounds_(rounds),
      seed_(seed) {
  all_ = {MatrixXd(0, d), MatrixXd(0, observed_.size())};
  propose({}, rounds_.first);
}

void ParameterSearch::propose(Proposal p, int count) {
  MatrixXd u = kronecker_points(count, d_);
  if (p.centres.rows() > 0) {
    StudyRandom random(
        seed_, StudyDraws(std::uint32_t(StudyDraws::first_proposal) + std::uint32_t(proposals_.size())));
    p.covariance.diagonal().array() += 1e-8;
    const MatrixXd root = p.covariance.llt().matrixL();
    for (Index i = 0; i < count; ++i) {
      VectorXd at;
      for (int tries = 0; tries < 200; ++tries) {
        VectorXd z(d_);
        for (Index j = 0; j < d_; ++j) z[j] = random.normal();
        at = p.centres.row(Index(random.below(std::size_t(p.centres.rows())))).transpose() + root * z;
        if ((at.array() > 0).all() && (at.array() < 1).all()) break;
      }
      u.row(i) = at.cwiseMax(0).cwiseMin(1).transpose();
    }
  }
  p.count = count;
  proposals_.push_back(std::move(p));
  round_begin_.push_back(all_.size());
  next_ = std::move(u);
}

std::vector<Index> ParameterSearch::rows_since(std::size_t round) const {
  std::vector<Index> rows;
  for (Index i = round < round_begin_.size() ? round_begin_[round] : all_.size(); i < all_.size(); ++i)
    rows.push_back(i);
  return rows;
}

// Distance by the statistics themselves and by a linear regression of the parameters on them: the first finds
// the region, the second weights the statistics by their information within it.
std::vector<Index> ParameterSearch::nearest(Index count) const {
  const Standard standard(all_.s);
  const MatrixXd z = standard(all_.s);
  const VectorXd seen = standard(observed_.transpose()).transpose();
  const VectorXd plain =
      (z.rowwise() - seen.transpose()).array().square().min(kMaxSquare).rowwise().mean().matrix();
  const MatrixXd u = all_.u.rowwise() - all_.u.colwise().mean();
  MatrixXd normal = z.transpose() * z;
  normal.diagonal().array() += 0.02 * double(all_.size());
  const MatrixXd guess = normal.ldlt().solve(z.transpose() * u);
  const VectorXd by_guess = ((z.rowwise() - seen.transpose()) * guess).rowwise().squaredNorm();
  const auto unit = [](const VectorXd& v) {
    return std::max(1e-12, median(std::vector<double>(v.begin(), v.end())));
  };
  return smallest(plain / unit(plain) + by_guess / unit(by_guess), count);
}

void ParameterSearch::take(const MatrixXd& statistics) {
  if (!next_ || statistics.rows() != next_->rows() || statistics.cols() != observed_.size())
    throw Error(Errc::internal, "parameter search", "statistics have the wrong size");
  std::vector<Index> good;
  for (Index i = 0; i < statistics.rows(); ++i)
    if (statistics.row(i).allFinite()) good.push_back(i);
  const int least = 3 * Emulator::terms(d_);
  if (int(good.size()) < least)
    throw Error(
        Errc::input, "identify",
        fmt::format(
            "only {} of {} simulations are valid, at least {} are needed; the others show no cells, or their "
            "parameters are not compatible",
            good.size(), statistics.rows(), least));
  const SimulationTable fresh{(*next_)(good, Eigen::all), statistics(good, Eigen::all)};
  MatrixXd u(all_.size() + fresh.size(), d_), s(all_.size() + fresh.size(), observed_.size());
  u << all_.u, fresh.u;
  s << all_.s, fresh.s;
  all_ = {std::move(u), std::move(s)};
  next_.reset();
  const std::size_t done = proposals_.size();
  if (done < narrowing_) {
    const Index near = std::max<Index>(Index(kNearFraction * double(all_.size())), Index(8) * d_);
    const MatrixXd centres = all_.u(nearest(near), Eigen::all);
    propose({centres, 2 * covariance_of(centres) / (done == 1 ? 1 : 2), 0}, rounds_.refinement);
    return;
  }
  fit_emulator();
  const std::size_t last = done - narrowing_;
  if (last == kMostLast || (last >= least_last_rounds(d_) && !truncated())) return;
  const MatrixXd draws = posterior({}, kProposalDraws, derived_seed(seed_, SeedUse::proposal));
  propose({draws.colwise().mean(), kWider * kWider * covariance_of(draws), 0}, rounds_.last);
}

// Whether the region of the last round truncates the posterior.
bool ParameterSearch::truncated() const {
  const MatrixXd draws = posterior({}, kProposalDraws, derived_seed(seed_, SeedUse::truncation));
  for (Index j = 0; j < d_; ++j) {
    const double near = 0.03 * (box_.high[j] - box_.low[j]);
    double below = 0, above = 0;
    for (const double u : draws.col(j)) {
      below += u < box_.low[j] + near;
      above += u > box_.high[j] - near;
    }
    const double most = kMaxAtLimit * double(draws.rows());
    if ((below > most && box_.low[j] > near) || (above > most && box_.high[j] < 1 - near)) return true;
  }
  return false;
}

// Sets region, centre, spread and emulator from the latest rounds.
void ParameterSearch::fit_emulator() {
  const bool last = proposals_.size() > narrowing_;
  const SimulationTable here = rows_of(all_, rows_since(last ? narrowing_ : 1));
  box_ = {here.u.colwise().minCoeff(), here.u.colwise().maxCoeff()};
  const std::vector<Index> near = nearest(std::max<Index>(10, all_.size() / 20));
  centre_ = last ? VectorXd(here.u.colwise().mean()) : VectorXd(all_.u(near, Eigen::all).colwise().mean());
  spread_ = covariance_of(here.u) / (last ? kWider * kWider : 1);
  emulator_ = std::make_unique<Emulator>(here.u, here.s);
}

SyntheticLikelihood ParameterSearch::likelihood(const std::vector<Index>& columns) const {
  const auto selected = columns.empty() ? all_columns(observed_.size()) : columns;
  const auto part = [&](SimulationTable t) { return SimulationTable{t.u, t.s(Eigen::all, selected)}; };
  const SimulationTable none{MatrixXd(0, d_), MatrixXd(0, Index(selected.size()))};
  if (proposals_.size() <= narrowing_)
    return {part(rows_of(all_, rows_since(1))), none, observed_(selected), centre_};
  // The compression is fitted to the simulations of earlier rounds near the region of the last one as well.
  const VectorXd margin = 0.5 * (box_.high - box_.low);
  const ParameterBox about{box_.low - margin, box_.high + margin};
  std::vector<Index> earlier;
  for (Index i = round_begin_[1]; i < round_begin_[narrowing_]; ++i)
    if (about.contains(all_.u.row(i).transpose())) earlier.push_back(i);
  return {part(rows_of(all_, rows_since(narrowing_))), part(rows_of(all_, earlier)), observed_(selected),
          centre_};
}

MatrixXd ParameterSearch::posterior(const std::vector<Index>& columns, int count, std::uint64_t seed) const {
  const SyntheticLikelihood l = likelihood(columns);
  return sample([&](const VectorXd& u) { return l.log_likelihood(u) + log_prior_(u); }, box_, centre_,
                spread_, count, seed);
}

ParameterSearch::WeightedDraws ParameterSearch::abc_posterior() const {
  const SyntheticLikelihood l = likelihood({});
  const SimulationTable t = rows_of(all_, rows_since(1));
  const VectorXd seen = l.compressed(observed_);
  MatrixXd c(t.size(), d_);
  for (Index i = 0; i < t.size(); ++i) c.row(i) = (l.compressed(t.s.row(i).transpose()) - seen).transpose();
  // In units of the spread of the last round.
  const Index from = round_begin_.back() - round_begin_[1];
  const VectorXd scale =
      c.bottomRows(t.size() - from).array().square().colwise().mean().sqrt().max(1e-12).inverse();
  const VectorXd distance = (c * scale.asDiagonal()).rowwise().norm();
  const auto near =
      smallest(distance, std::max<Index>(Index(kAbcFraction * double(t.size())), Index(10) * d_));
  const double reach = std::max(distance[near.back()], 1e-300);
  WeightedDraws w{MatrixXd(near.size(), d_), VectorXd(near.size())};
  MatrixXd x(near.size(), d_ + 1);
  for (std::size_t k = 0; k < near.size(); ++k) {
    const VectorXd u = t.u.row(near[k]).transpose();
    double proposed = 0;
    for (std::size_t r = 1; r < proposals_.size(); ++r)
      proposed += double(proposals_[r].count) * proposals_[r].density(u);
    const double kernel = 1 - std::pow(distance[near[k]] / reach, 2) + 1e-6;  // Epanechnikov
    w.u.row(Index(k)) = u.transpose();
    w.weight[Index(k)] = kernel * std::exp(log_prior_(u)) / proposed;
    x.row(Index(k)) << 1, c.row(near[k]);
  }
  w.weight /= w.weight.sum();
  const MatrixXd normal = x.transpose() * w.weight.asDiagonal() * x;
  const MatrixXd line = normal.ldlt().solve(x.transpose() * w.weight.asDiagonal() * w.u);
  w.u -= x.rightCols(d_) * line.bottomRows(d_);
  w.u = w.u.cwiseMax(0).cwiseMin(1);
  return w;
}

}  // namespace faba
