#include "study/calibrate/calibration.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "core/counted.h"
#include "core/error.h"
#include "core/random/distributions.h"
#include "study/calibrate/true_experiment.h"
#include "study/identify/response/measured_response.h"
#include "study/stats/statistics.h"

namespace faba {
namespace {

constexpr double kMainLevel = 0.9;  // of kCoverageLevels

using Design = std::vector<ResponseVideo>;

Round experiments_of(const CalibrationStudy& study, Design videos, const std::function<bool()>& stop) {
  for (ResponseVideo& v : videos)
    for (auto& pictures : v.pictures) pictures.clear();  // each experiment copies the videos
  check_kinds(study, videos);
  const auto design = std::make_shared<const Design>(std::move(videos));
  Round round;
  round.description = "calibration 1";
  round.size = study.experiments();
  round.work = [&study, design, stop](std::uint64_t task) {
    return calibration_experiment(study, *design, task, stop).values();
  };
  round.labels = [&study](std::uint64_t task) {
    const auto [kind, number] = study.kind_of(task);
    const ExperimentKind& k = study.kinds[kind];
    const Candidate& c = study.design.candidates[k.true_models[number % k.true_models.size()]];
    return std::vector<TaskLabel>{{"kind", k.name},
                                  {"model", c.model.name},
                                  {"experiment", fmt::format("{}", number + 1), double(number + 1)}};
  };
  return round;
}

ParameterCalibration parameter_of(const FreeParameter& parameter, std::vector<CalibratedEstimate> estimates) {
  ParameterCalibration p{.parameter = parameter, .estimates = std::move(estimates)};
  std::vector<double> ranks, z, relative, error, range;
  for (const CalibratedEstimate& e : p.estimates) {
    ranks.push_back(e.rank);
    z.push_back((e.mean - e.truth) / std::max(e.sd, 1e-300));
    relative.push_back(e.truth > 0 ? e.median / e.truth - 1 : kNaN);
    error.push_back(std::fabs(relative.back()));
    range.push_back(e.fraction_of_range);
  }
  for (const double level : kCoverageLevels) p.coverage.push_back(coverage_of(ranks, level));
  p.ranks = rank_histogram(ranks);
  p.bias = mean(z);
  p.spread = z.size() > 1 ? sample_sd(z) : kNaN;
  p.bias_se = p.spread / std::sqrt(double(z.size()));
  p.relative_bias = parameter.low > 0 ? median(relative) : kNaN;
  p.relative_error = parameter.low > 0 ? median(error) : kNaN;
  p.fraction_of_range = median(range);
  return p;
}

// Of the well-specified experiments, which come first.
ModelCalibration model_of(const StudyCalibration& c, std::size_t model) {
  const Candidate& candidate = c.study.design.candidates[model];
  ModelCalibration m{.name = candidate.model.name};
  std::vector<std::vector<CalibratedEstimate>> estimates(candidate.free.size());
  std::vector<double> tarp;
  for (std::size_t i = 0; i < std::size_t(c.study.kinds.front().experiments); ++i) {
    const CalibrationRecord& r = c.records[i];
    if (r.true_model != double(model) || r.estimates.empty()) continue;
    for (std::size_t j = 0; j < estimates.size(); ++j) estimates[j].push_back(r.estimates[j]);
    tarp.push_back(r.tarp);
  }
  m.experiments = int(tarp.size());
  if (tarp.empty()) return m;
  for (std::size_t j = 0; j < estimates.size(); ++j)
    m.parameters.push_back(parameter_of(candidate.free[j], std::move(estimates[j])));
  m.tarp = rank_curve(std::move(tarp));
  return m;
}

template <class Test>
ExperimentCount count_of(const std::vector<CalibrationRecord>& records, const Test& test) {
  ExperimentCount n;
  for (const CalibrationRecord& r : records) {
    if (r.failed) continue;
    ++n.of;
    n.count += test(r);
  }
  if (n.of > 0) {
    const FractionInterval i = binomial_interval(n.count, n.of, 0.95);
    n.ci95 = {i.low, i.high};
  }
  return n;
}

bool contains_truth(const CalibrationRecord& r) {
  if (r.estimates.empty()) return false;
  const CalibratedEstimate& e = r.estimates.front();
  return e.low90 <= e.truth && e.truth <= e.high90;
}

SelectionCalibration selection_of(const ExperimentKind& kind, bool several,
                                  const std::vector<CalibrationRecord>& records) {
  using Record = CalibrationRecord;
  SelectionCalibration s{
      .kind = kind.name, .misspecified = kind.misspecified, .experiments = kind.experiments};
  for (const Record& r : records) {
    s.failed += r.failed;
    s.sampled_again += int(r.samples) - 1;
  }
  s.named = count_of(records, [](const Record& r) { return r.named > 0; });
  s.warned = count_of(records, [](const Record& r) { return r.warnings > 0; });
  s.inside = count_of(records, contains_truth);
  if (!several) return s;
  const auto clear = [](const Record& r) { return r.evidence == 2; };
  const auto wrong = [&](const Record& r) { return clear(r) && r.best != r.true_model; };
  const auto confident = [&](const Record& r) { return wrong(r) || (clear(r) && !contains_truth(r)); };
  s.best_is_true = count_of(records, [](const Record& r) { return r.best == r.true_model; });
  s.clear = count_of(records, clear);
  s.weak = count_of(records, [](const Record& r) { return r.evidence == 1; });
  s.wrong_clear = count_of(records, wrong);
  s.false_clear = count_of(records, confident);
  s.false_clear_unnamed = count_of(records, [&](const Record& r) { return confident(r) && r.named == 0; });
  return s;
}

std::optional<StudyCalibration> analysed(const CalibrationStudy& study, const Round& round,
                                         const ResultStore& results) {
  StudyCalibration c{study, {}, {}, {}};
  const std::uint64_t key = results.key(round);
  for (std::uint64_t i = 0; i < round.size; ++i)
    c.records.push_back(CalibrationRecord::of(results.find({key, i}).value()));
  std::vector<std::size_t> models = study.kinds.front().true_models;
  std::sort(models.begin(), models.end());
  models.erase(std::unique(models.begin(), models.end()), models.end());
  if (study.kinds.front().experiments > 0)
    for (const std::size_t m : models) c.models.push_back(model_of(c, m));
  auto next = c.records.begin();
  for (const ExperimentKind& kind : study.kinds) {
    const auto end = next + kind.experiments;
    if (kind.experiments > 0)
      c.kinds.push_back(selection_of(kind, study.design.candidates.size() > 1, {next, end}));
    next = end;
  }
  return c;
}

}  // namespace

std::optional<StudyCalibration> calibrate(const CalibrationStudy& study, ResultStore& results,
                                          const SweepOptions& options, const std::function<void()>& reading) {
  const Round round = experiments_of(study, measured_responses(study.design, options, reading), options.stop);
  if (!sweep(results, round, options)) return {};
  return analysed(study, round, results);
}

Round calibration_round(const CalibrationStudy& study, const std::filesystem::path& measured,
                        const std::function<bool()>& stop) {
  return experiments_of(study, stored_responses(study.design, measured), stop);
}

namespace {

// With few experiments all of them may be inside of a calibrated interval.
void warn_few(const ModelCalibration& m, std::vector<Warning>& out) {
  if (m.parameters.empty()) return;
  for (const Coverage& o : m.parameters.front().coverage)
    if (o.level == kMainLevel && !o.tells())
      out.push_back(
          {"experiments",
           fmt::format("with {} of {}, {:g} % intervals that are too wide cannot be detected",
                       counted(std::size_t(o.experiments), "experiment"), m.name, 100 * o.level),
           fmt::format("right intervals contain the true value in {} to {} of them (99 %)", o.low, o.high),
           "increase experiments; the default is 100", Quality::doubtful});
}

}  // namespace

std::vector<Warning> calibration_warnings(const StudyCalibration& c) {
  std::vector<Warning> out;
  for (const ModelCalibration& m : c.models) {
    warn_few(m, out);
    for (const ParameterCalibration& p : m.parameters)
      for (const Coverage& o : p.coverage)
        if (!o.within())
          out.push_back({"coverage",
                         fmt::format("the {:g} % intervals of {} of {} are too {}", 100 * o.level,
                                     p.parameter.path, m.name, o.inside < o.low ? "narrow" : "wide"),
                         fmt::format("{} of {} contain the true value; {} to {} are expected (99 %)",
                                     o.inside, o.experiments, o.low, o.high),
                         "increase simulations, or give narrower prior ranges", Quality::doubtful});
  }
  for (const SelectionCalibration& s : c.kinds)
    if (s.failed > 0)
      out.push_back(
          {"failed",
           fmt::format("{} of {} experiments ({}) could not be identified", s.failed, s.experiments, s.kind),
           "", "give narrower prior ranges", Quality::doubtful});
  return out;
}

}  // namespace faba
