#include "study/identify/simulation_round.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "app/scenario/parts.h"
#include "app/scenario/read_scenario.h"
#include "core/error.h"
#include "core/hash.h"

namespace faba {
namespace {

using Eigen::Index;
using Eigen::MatrixXd;
using Eigen::VectorXd;

// Standard deviation of the time of a field reversal, frames: given to within one frame (uniform), and
// detected from the path of the swarm.
constexpr double kTimingGiven = 0.58, kTimingDetected = 1.5;
constexpr double kLargestError = 2.5;  // sd

std::string digest(const VectorXd& v) {
  Hash h;
  h.values(std::span<const double>(v.data(), std::size_t(v.size())));
  return h.hex();
}

// Factor of a quantity with a relative uncertainty.
double factor(StudyRandom& random, double relative_sd) {
  const double z = std::clamp(random.normal(), -kLargestError, kLargestError);
  return std::exp(relative_sd * z);
}

bool given(const Candidate& c, const std::string& path) {
  return std::any_of(c.free.begin(), c.free.end(), [&](const auto& p) { return p.path == path; }) ||
         std::any_of(c.model.set.begin(), c.model.set.end(), [&](const auto& s) { return s.first == path; });
}

void scale_counts(Document& d, const Candidate& c, double times) {
  Json& swarms = d.root["swarm"];
  for (std::size_t i = 0; i < swarms.size(); ++i)
    if (!given(c, fmt::format("swarm[{}].count", i)))
      swarms[i]["count"] = std::max<std::int64_t>(1, std::llround(times * swarms[i]["count"].get<double>()));
}

std::uint64_t seed_of(std::initializer_list<std::uint64_t> values) {
  Hash h;
  for (const std::uint64_t x : values) h.value(x);
  return h.result() >> 1;
}

EpisodeSettings settings_of(const IdentifyStudy& study, const Candidate& c, const ResponseVideo& v) {
  return {study.boundary, study.scene, c.model, c.field_strength_in(v)};
}

Document with_parameters(Document d, const Candidate& c, const VectorXd& u) {
  for (std::size_t j = 0; j < c.free.size(); ++j) d.set(c.free[j].path, c.free[j].json(u[Index(j)]), "free");
  return d;
}

}  // namespace

Document candidate_scenario(const IdentifyStudy& study, const Candidate& c, const ResponseVideo& v,
                            const Episode& e, const VectorXd& u, const SegmentTiming& timing) {
  return with_parameters(episode_scenario(v, e, settings_of(study, c, v), timing), c, u);
}

SimulationRound::SimulationRound(const IdentifyStudy& study, const std::vector<ResponseVideo>& videos,
                                 const ObservedStatistics& observed)
    : study_(study), videos_(videos), observed_(observed), observed_digest_(digest(observed.numbers)) {}

void SimulationRound::add(std::size_t candidate, const MatrixXd& u, std::size_t number,
                          const ModelFamily* family) {
  for (Index i = 0; i < u.rows(); ++i)
    for (std::size_t p = 0; p < observed_.parts.size(); ++p)
      add_one(candidate, u.row(i).transpose(), number, i, p, family);
}

void SimulationRound::add_one(std::size_t candidate, const VectorXd& u, std::size_t number, Index i,
                              std::size_t p, const ModelFamily* family) {
  const Candidate& c = study_.candidates[candidate];
  const ObservedStatistics::Part& part = observed_.parts[p];
  const ResponseVideo& video = videos_[part.video];
  const Episode& episode = video.episodes[part.episode];
  // Independent seed for each simulation.
  const std::uint64_t seed = seed_of({study_.seed, candidate, number, std::uint64_t(i), p});
  // Scale and field are those of the camera and the coils: the same in all episodes of a simulation.
  StudyRandom common(seed_of({study_.seed, candidate, number, std::uint64_t(i)}), StudyDraws::apparatus),
      own(seed, StudyDraws::apparatus);
  EpisodeSettings settings = settings_of(study_, c, video);
  settings.scale_factor = factor(common, study_.scale_sd);
  settings.field_strength_t *= factor(common, study_.field_sd);
  const double timing_sd = (video.segments_detected ? kTimingDetected : kTimingGiven) / video.fps;
  SegmentTiming timing = random_timing(episode, study_.timing_s.value_or(timing_sd), seed);
  if (family) {
    settings.field_strength_t *= family->field_factor;
    for (double& start : timing.starts_s) start += family->delay_frames / video.fps;
  }
  Document scenario = with_parameters(episode_scenario(video, episode, settings, timing), c, u);
  scale_counts(scenario, c, factor(own, study_.count_sd));
  if (family && family->edit) family->edit(scenario);
  const auto d = std::make_shared<const Document>(std::move(scenario));
  const std::string key = task_key(fmt::format("response 1 {} {} {} {} {} {}", d->root.dump(), seed,
                                               timing.lead_s, observed_digest_, p, int(study_.look)));
  tasks_.push_back({key, [this, d, seed, lead = timing.lead_s, &part, &video] {
                      try {
                        const EpisodeObservation seen =
                            simulate_episode(read_scenario(*d, builtin_parts()), seed, lead,
                                             part.statistics->times_s(), study_.look, video.ground);
                        std::vector<double> numbers = study_.look == Look::video
                                                          ? part.statistics->of_frames(seen.frames)
                                                          : part.statistics->of_positions(seen.positions);
                        StudyRandom random(seed, StudyDraws::measurement);
                        part.statistics->blur(numbers, random);
                        return numbers;
                      } catch (const Error& e) {
                        if (e.code() != Errc::usage) throw;
                        // Incompatible values, such as speeds that need too many steps.
                        return std::vector<double>(std::size_t(part.count), std::nan(""));
                      }
                    }});
}

MatrixXd SimulationRound::take(const ResultStore& results, Index rows) {
  MatrixXd s = MatrixXd::Constant(rows, observed_.numbers.size(), std::nan(""));
  for (Index i = 0; i < rows; ++i)
    for (const ObservedStatistics::Part& part : observed_.parts) {
      const std::vector<double>& values = *results.find(tasks_[taken_++].key);
      if (Index(values.size()) != part.count)
        throw Error(
            Errc::usage, "results.jsonl",
            fmt::format("result with {} numbers, expected {}; delete the file to compute all results again",
                        values.size(), part.count));
      s.row(i).segment(part.begin, part.count) =
          Eigen::Map<const VectorXd>(values.data(), part.count).transpose();
    }
  return s;
}

}  // namespace faba
