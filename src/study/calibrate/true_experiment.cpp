#include "study/calibrate/true_experiment.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "app/scenario/parts.h"
#include "app/scenario/read_scenario.h"
#include "core/error.h"
#include "core/hash.h"
#include "study/calibrate/rendered_experiment.h"
#include "study/identify/sampled_episode.h"

namespace faba {
namespace {

using Eigen::Index;
using Eigen::VectorXd;

constexpr int kMostSamples = 100;  // of the parameters of an experiment

// Cells of the opposite polarity do not gather where the others do: their headings are random.
void release_opposite(Json& swarms) {
  const auto polarity = [](const Json& swarm) { return swarm.value("polarity", "south"); };
  for (std::size_t i = 1; i < swarms.size(); ++i)
    if (polarity(swarms[i]) != polarity(swarms[0])) swarms[i].erase("heading");
}

ModelFamily difference_of(const ExperimentKind& kind) {
  ModelFamily f;
  f.field_factor = kind.field_factor;
  f.edit = [&kind](Document& d) {
    if (kind.second_swarm > 0) divide_swarm(d, kind.second_swarm);
    for (const auto& [path, value] : kind.set) d.set(path, value, kind.where);
    release_opposite(d.root["swarm"]);
  };
  return f;
}

// The value that a misspecified experiment sets, else the sampled one.
double true_value(const FreeParameter& p, double u, const ExperimentKind& kind) {
  for (const auto& [path, value] : kind.set)
    if (path == p.path) {
      Document d;
      d.root["value"] = value;
      return read_value(Node(d).child("value"), p);
    }
  return p.value(u);
}

std::vector<ResponseVideo> observed_positions(const IdentifyStudy& study, const Candidate& c,
                                              const std::vector<ResponseVideo>& design, const VectorXd& u,
                                              std::uint64_t seed, const ModelFamily& difference) {
  std::vector<ResponseVideo> videos = design;
  std::uint64_t part = 0;
  for (ResponseVideo& v : videos)
    for (std::size_t e = 0; e < v.episodes.size(); ++e) {
      const EpisodeSeeds seeds{seed, seed + ++part};
      const SampledEpisode sampled = sampled_episode(study, c, v, v.episodes[e], u, seeds, &difference);
      v.observed[e] = sampled_statistics(study, v, *v.statistics[e], sampled, seeds);
    }
  return videos;
}

bool measurable(const std::vector<ResponseVideo>& videos) {
  for (const ResponseVideo& v : videos)
    for (const std::vector<double>& numbers : v.observed)
      if (!std::all_of(numbers.begin(), numbers.end(), [](double x) { return std::isfinite(x); }))
        return false;
  return true;
}

}  // namespace

std::uint64_t experiment_seed(const CalibrationStudy& study, std::uint64_t experiment,
                              ExperimentSeed purpose) {
  const auto [kind, number] = study.kind_of(experiment);
  Hash h;
  for (const std::uint64_t x : {study.seed, std::uint64_t(kind), number, std::uint64_t(purpose)}) h.value(x);
  return h.result() >> 2;
}

VectorXd sampled_prior(const Candidate& c, StudyRandom& random) {
  VectorXd u(Index(c.free.size()));
  for (std::size_t j = 0; j < c.free.size(); ++j) {
    // Rejection: the logarithm of the density is at most 0.
    do u[Index(j)] = random.uniform();
    while (std::log(random.uniform()) > c.free[j].log_prior(u[Index(j)]));
  }
  return u;
}

void check_kinds(const CalibrationStudy& study, const std::vector<ResponseVideo>& design) {
  const ResponseVideo& v = design.front();
  for (const ExperimentKind& kind : study.kinds)
    for (const std::size_t model : kind.true_models) {
      const Candidate& c = study.design.candidates[model];
      const ModelFamily difference = difference_of(kind);
      const VectorXd middle = VectorXd::Constant(Index(c.free.size()), 0.5);
      for (const FreeParameter& p : c.free) (void)true_value(p, 0.5, kind);
      const SampledEpisode sampled =
          sampled_episode(study.design, c, v, v.episodes.front(), middle, {1, 1}, &difference);
      (void)read_scenario(sampled.scenario, builtin_parts());
    }
}

TrueExperiment true_experiment(const CalibrationStudy& study, const std::vector<ResponseVideo>& design,
                               std::uint64_t experiment, const std::function<void()>& tick) {
  const auto [k, number] = study.kind_of(experiment);
  const ExperimentKind& kind = study.kinds[k];
  TrueExperiment t;
  t.model = kind.true_models[number % kind.true_models.size()];
  const Candidate& c = study.design.candidates[t.model];
  const ModelFamily difference = difference_of(kind);
  IdentifyStudy truth = study.design;
  if (kind.timing_s) truth.timing_s = kind.timing_s;
  StudyRandom random(experiment_seed(study, experiment, ExperimentSeed::truth), StudyDraws::truth);
  const std::uint64_t seed = experiment_seed(study, experiment, ExperimentSeed::simulation);
  for (std::uint64_t i = 0; i < kMostSamples; ++i) {
    const VectorXd u = sampled_prior(c, random);
    t.truth.clear();
    t.samples = int(i) + 1;
    for (std::size_t j = 0; j < c.free.size(); ++j)
      t.truth.push_back(true_value(c.free[j], u[Index(j)], kind));
    try {
      t.videos = study.design.look == Look::video
                     ? rendered_experiment(truth, c, design, u, seed + (i << 20), difference, tick)
                     : observed_positions(truth, c, design, u, seed + (i << 20), difference);
    } catch (const Error& e) {
      if (e.code() != Errc::usage && e.code() != Errc::input) throw;
      continue;
    }
    if (measurable(t.videos)) return t;
  }
  throw Error(Errc::input, study.designed_by,
              fmt::format("none of {} experiments with parameters of {} from the prior can be measured; give "
                          "narrower ranges",
                          kMostSamples, c.model.name));
}

}  // namespace faba
