#include "study/calibrate/experiment.h"

#include <algorithm>
#include <cmath>

#include "core/error.h"
#include "study/calibrate/true_experiment.h"
#include "study/identify/identify.h"
#include "study/identify/identify_warnings.h"

namespace faba {
namespace {

constexpr std::size_t kFirstValues = 9, kEstimateValues = 8;

// Rank of the true value among the samples of the posterior, as a fraction; equal values, which integer
// parameters have, are ordered at random.
double rank_of(double truth, const std::vector<double>& draws, StudyRandom& random) {
  double below = 0, equal = 1;  // the true value itself
  for (const double x : draws) {
    below += x < truth;
    equal += x == truth;
  }
  return (below + random.uniform() * equal) / double(draws.size() + 1);
}

CalibratedEstimate estimate_of(const FoundParameter& p, double truth, StudyRandom& random) {
  return {.truth = truth,
          .mean = mean(p.draws),
          .median = p.median,
          .sd = sample_sd(p.draws),
          .low90 = p.ci90[0],
          .high90 = p.ci90[1],
          .fraction_of_range = p.fraction_of_range,
          .rank = rank_of(truth, p.draws, random)};
}

// Distances are those of fractions of the prior ranges; the reference point is uniform on them.
double tarp_of(const FoundModel& m, const std::vector<double>& truth, StudyRandom& random) {
  const std::size_t d = truth.size(), n = m.parameters.front().draws.size();
  std::vector<double> squared(n, 0.0);
  double of_truth = 0;
  for (std::size_t j = 0; j < d; ++j) {
    const FreeParameter& p = m.parameters[j].parameter;
    const double at = random.uniform();
    of_truth += std::pow(p.fraction(truth[j]) - at, 2);
    for (std::size_t k = 0; k < n; ++k) squared[k] += std::pow(p.fraction(m.parameters[j].draws[k]) - at, 2);
  }
  return rank_of(of_truth, squared, random);
}

double evidence_number(const std::string& word) { return word == "clear" ? 2 : word == "weak" ? 1 : 0; }

}  // namespace

std::vector<double> CalibrationRecord::values() const {
  std::vector<double> v{double(failed), true_model, best, evidence, fit_p, warnings, samples, named, tarp};
  for (const CalibratedEstimate& e : estimates)
    v.insert(v.end(), {e.truth, e.mean, e.median, e.sd, e.low90, e.high90, e.fraction_of_range, e.rank});
  return v;
}

CalibrationRecord CalibrationRecord::of(std::span<const double> v) {
  if (v.size() < kFirstValues || (v.size() - kFirstValues) % kEstimateValues != 0)
    throw Error(Errc::usage, "results", "damaged; delete the folder to compute all results again");
  CalibrationRecord r{v[0] != 0, v[1], v[2], v[3], v[4], v[5], v[6], v[7], v[8], {}};
  for (std::size_t i = kFirstValues; i < v.size(); i += kEstimateValues)
    r.estimates.push_back({v[i], v[i + 1], v[i + 2], v[i + 3], v[i + 4], v[i + 5], v[i + 6], v[i + 7]});
  return r;
}

std::vector<std::string> CalibrationRecord::names() {
  return {"failed", "true_model", "best", "evidence", "fit_p", "warnings", "samples", "named", "tarp"};
}

CalibrationRecord calibration_experiment(const CalibrationStudy& study,
                                         const std::vector<ResponseVideo>& design, std::uint64_t experiment,
                                         const std::function<bool()>& stop) {
  const ExperimentKind& kind = study.kinds[study.kind_of(experiment).first];
  const TrueExperiment t = true_experiment(study, design, experiment, [&] {
    if (stop()) throw study_stopped();
  });
  IdentifyStudy settings = study.design;
  settings.seed = experiment_seed(study, experiment, ExperimentSeed::identification);
  ResultStore results({}, "");
  SweepOptions options;
  options.threads = 1;
  options.stop = stop;
  CalibrationRecord r;
  r.true_model = double(t.model);
  r.samples = t.samples;
  try {
    const std::optional<Identification> found = identify(settings, t.videos, results, options);
    const FoundModel& m = found->models[t.model];
    const std::vector<Warning> warnings = identify_warnings(*found);
    r.failed = false;
    r.best = double(found->best);
    r.evidence = evidence_number(found->evidence);
    r.fit_p = found->models[found->best].fit_p;
    r.warnings = double(warnings.size());
    r.named = std::any_of(warnings.begin(), warnings.end(), [&](const Warning& w) {
      return std::find(kind.aspects.begin(), kind.aspects.end(), w.aspect) != kind.aspects.end();
    });
    if (!m.failed.empty()) return r;
    StudyRandom random(experiment_seed(study, experiment, ExperimentSeed::ranks), StudyDraws::reference);
    for (std::size_t j = 0; j < t.truth.size(); ++j)
      r.estimates.push_back(estimate_of(m.parameters[j], t.truth[j], random));
    r.tarp = tarp_of(m, t.truth, random);
  } catch (const Error& e) {
    if (e.code() != Errc::input) throw;  // the experiment cannot be identified
  }
  return r;
}

}  // namespace faba
