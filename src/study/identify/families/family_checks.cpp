#include "study/identify/families/family_checks.h"

#include <algorithm>
#include <cmath>

#include "core/statistics.h"
#include "study/identify/derived_seed.h"
#include "study/identify/families/misfit.h"
#include "study/identify/simulation_round.h"

namespace faba {
namespace {

using Eigen::Index;
using Eigen::MatrixXd;
using Eigen::VectorXd;

constexpr int kPredictive = 40;           // simulations of the posterior prediction
constexpr int kPairs = 16;                // of them that are repeated with each family
constexpr std::size_t kNumber = 1000000;  // round number that no search reaches
// Probability that any of the families of a model that is right is significant.
constexpr double kFamilyLevel = 0.01;
// Families whose squared t differs by less than this are not distinguished: a difference of 2 in the
// log-likelihood.
constexpr double kEqual = 4;

bool finite(const MatrixXd& s, Index row) { return s.row(row).allFinite(); }

std::vector<Index> finite_rows(const MatrixXd& s) {
  std::vector<Index> rows;
  for (Index i = 0; i < s.rows(); ++i)
    if (finite(s, i)) rows.push_back(i);
  return rows;
}

std::vector<std::array<double, 2>> intervals(const MatrixXd& simulated) {
  std::vector<std::array<double, 2>> out;
  for (Index k = 0; k < simulated.cols(); ++k) {
    std::vector<double> v;
    for (const double x : simulated.col(k))
      if (std::isfinite(x)) v.push_back(x);
    out.push_back(v.empty() ? std::array{std::nan(""), std::nan("")}
                            : std::array{quantile(v, 0.05), quantile(v, 0.95)});
  }
  return out;
}

// Change of the statistics when all cells drift in the direction of the first field segment.
VectorXd drift_change(const ObservedStatistics& o, const std::vector<ResponseVideo>& videos, double px_s) {
  const Vec2 direction = unit_vector(videos.front().episodes.front().segments.front().direction_deg);
  VectorXd change(o.numbers.size());
  for (const ObservedStatistics::Part& part : o.parts) {
    const std::vector<double> values = part.statistics->of_drift(px_s * direction);
    change.segment(part.begin, part.count) = Eigen::Map<const VectorXd>(values.data(), part.count);
  }
  return change;
}

// Mean change between pairs of simulations with equal random numbers; zero without pairs.
VectorXd mean_change(const MatrixXd& with, const MatrixXd& without) {
  VectorXd sum = VectorXd::Zero(with.cols());
  double pairs = 0;
  for (Index i = 0; i < with.rows(); ++i)
    if (finite(with, i) && finite(without, i)) {
      sum += (with.row(i) - without.row(i)).transpose();
      pairs += 1;
    }
  return sum / std::max(1.0, pairs);
}

ModelPrediction prediction_of(const ParameterSearch& search, const MatrixXd& u, const MatrixXd& simulated) {
  const Emulator& e = search.emulator();
  return {simulated(finite_rows(simulated), Eigen::all), e.slope(u.colwise().mean().transpose()),
          e.covariance(), e.freedom()};
}

void sort_and_name(std::vector<FamilyCheck>& checks) {
  std::stable_sort(checks.begin(), checks.end(), [](const auto& a, const auto& b) { return a.p < b.p; });
  double best = 0;
  for (FamilyCheck& c : checks) {
    // An extension that does not bring the prediction nearer to the videos explains nothing, and one whose
    // effect is below the resolution of the statistics explains an error of the measurement.
    c.significant =
        c.p < kFamilyLevel / double(checks.size()) && c.explained > 0 && c.effect >= kStatisticResolution;
    if (c.significant) best = std::max(best, c.t * c.t);
  }
  for (FamilyCheck& c : checks) c.named = c.significant && c.t * c.t > best - kEqual;
}

/// A model, its families, and its simulations.
struct Tested {
  MatrixXd u, simulated;
  std::vector<ModelFamily> families;
  std::vector<VectorXd> changes;
};

void extend(SearchedModel& m, const Tested& t, const ModelPrediction& prediction, const ObservedStatistics& o,
            const VectorXd& scale, std::size_t family, std::size_t check) {
  if (o.columns.size() < 2) return;
  std::vector<double> scores;
  double sum = 0;
  for (std::size_t e = 0; e < o.columns.size(); ++e) {
    std::vector<Index> others;
    for (std::size_t k = 0; k < o.columns.size(); ++k)
      if (k != e) others.insert(others.end(), o.columns[k].begin(), o.columns[k].end());
    std::sort(others.begin(), others.end());
    const VectorXd shift = predicted_shift(prediction, o.numbers, t.changes[family],
                                           t.families[family].two_sided, others, o.columns[e]);
    scores.push_back(energy_score(m.samples[e].rowwise() + shift.transpose(), o.numbers(o.columns[e]),
                                  scale(o.columns[e])));
    sum += scores.back();
  }
  double lowest = 0;
  for (const double x : m.found->extended_scores) lowest += x;
  if (m.found->extension && lowest <= sum) return;
  m.found->extension = check;
  m.found->extended_scores = std::move(scores);
}

void test_families(SearchedModel& m, const Tested& t, const ObservedStatistics& o, const VectorXd& scale) {
  const ModelPrediction prediction = prediction_of(*m.search, t.u, t.simulated);
  if (prediction.simulated.rows() < kPredictive / 2) return;
  std::vector<FamilyCheck>& checks = m.found->families;
  for (std::size_t f = 0; f < t.families.size(); ++f) {
    const ModelFamily& family = t.families[f];
    const ScoreTest test = score_test(prediction, o.numbers, t.changes[f], family.two_sided);
    checks.push_back({family.aspect, family.what, family.unit, family.advice, test.amount * family.amount,
                      test.sd * family.amount, test.t, test.p, test.explained, test.effect});
  }
  sort_and_name(checks);
  for (std::size_t c = 0; c < checks.size(); ++c)
    for (std::size_t f = 0; f < t.families.size(); ++f)
      if (t.families[f].what == checks[c].what && t.families[f].of_cells)
        extend(m, t, prediction, o, scale, f, c);
}

Tested plan(const IdentifyStudy& study, const std::vector<ResponseVideo>& videos, const SearchedModel& m,
            const Candidate& c, SimulationRound& round, std::size_t candidate) {
  Tested t;
  t.u = m.search->posterior({}, kPredictive, derived_seed(study.seed, SeedUse::best_model));
  const VectorXd at = t.u.colwise().mean().transpose();
  t.families = families_at(study, videos, c, at);
  round.add(candidate, t.u, kNumber);
  for (std::size_t f = 0; f < t.families.size(); ++f)
    if (t.families[f].drift_px_s == 0)
      round.add(candidate, t.u.topRows(kPairs), kNumber, FamilyChoice{at, f});
  return t;
}

}  // namespace

bool check_families(const IdentifyStudy& study, const std::vector<ResponseVideo>& videos,
                    const ObservedStatistics& o, std::vector<SearchedModel>& models, const VectorXd& scale,
                    ResultStore& results, const SweepOptions& options) {
  SimulationRound round(study, videos, o);
  std::vector<Tested> tested(models.size());
  for (std::size_t c = 0; c < models.size(); ++c)
    if (models[c].search) tested[c] = plan(study, videos, models[c], study.candidates[c], round, c);
  if (!round.run(results, options)) return false;
  for (std::size_t c = 0; c < models.size(); ++c) {
    if (!models[c].search) continue;
    Tested& t = tested[c];
    t.simulated = round.take(results, t.u.rows());
    models[c].found->predicted90 = intervals(t.simulated);
    for (const ModelFamily& f : t.families)
      t.changes.push_back(f.drift_px_s != 0
                              ? drift_change(o, videos, f.drift_px_s)
                              : mean_change(round.take(results, kPairs), t.simulated.topRows(kPairs)));
    test_families(models[c], t, o, scale);
  }
  return true;
}

}  // namespace faba
