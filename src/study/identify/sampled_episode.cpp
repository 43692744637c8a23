#include "study/identify/sampled_episode.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "app/scenario/parts.h"
#include "app/scenario/read_scenario.h"

namespace faba {
namespace {

using Eigen::Index;
using Eigen::VectorXd;

// Standard deviation of the time of a field reversal, frames: given to within one frame (uniform), and
// detected from the path of the swarm.
constexpr double kTimingGiven = 0.58, kTimingDetected = 1.5;
constexpr double kLargestError = 2.5;  // sd
// Time before an episode in which cells gather at a boundary (assumed): in it slow cells fall behind fast
// ones, and headings get their thermal spread.
constexpr double kHistory_s = 2;

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

// Frames after which the clock of the models repeats: those of the thesis draw velocities every `hold`
// iterations.
int clock_frames(const Json& scenario, double fps) {
  double iterations = 1;
  for (std::size_t i = 0; i < scenario["swarm"].size(); ++i)
    iterations =
        std::max(iterations, scenario_number(fmt::format("swarm[{}].model.hold", i), scenario).value_or(1));
  const double frames = scenario_number("scale.iteration", scenario).value_or(1 / fps) * fps;
  return std::max(1, int(std::lround(iterations * std::max(1.0, frames))));
}

int history_frames(Boundary boundary, double fps) {
  return boundary == Boundary::none ? 0 : int(std::lround(kHistory_s * fps));
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

SampledEpisode sampled_episode(const IdentifyStudy& study, const Candidate& c, const ResponseVideo& v,
                               const Episode& e, const VectorXd& u, const EpisodeSeeds& seeds,
                               const ModelFamily* change) {
  // Scale and field are those of the camera and the coils: the same in all episodes of a simulation.
  StudyRandom common(seeds.simulation, StudyDraws::apparatus), own(seeds.episode, StudyDraws::apparatus);
  EpisodeSettings settings = settings_of(study, c, v);
  settings.scale_factor = factor(common, study.scale_sd);
  settings.field_strength_t *= factor(common, study.field_sd);
  const double timing_sd = (v.segments_detected ? kTimingDetected : kTimingGiven) / v.fps;
  const Document exact = candidate_scenario(study, c, v, e, u, exact_timing(e));
  SampledEpisode sampled{{},
                         random_timing(e,
                                       {.sd_s = study.timing_s.value_or(timing_sd),
                                        .frame_s = 1 / v.fps,
                                        .clock_frames = clock_frames(exact.root, v.fps),
                                        .history_frames = history_frames(study.boundary, v.fps)},
                                       seeds.episode),
                         e.segments.front().direction_deg};
  if (change) {
    settings.field_strength_t *= change->field_factor;
    for (double& start : sampled.timing.starts_s) start += change->delay_frames / v.fps;
  }
  sampled.scenario = with_parameters(episode_scenario(v, e, settings, sampled.timing), c, u);
  scale_counts(sampled.scenario, c, factor(own, study.count_sd));
  if (change && change->edit) change->edit(sampled.scenario);
  return sampled;
}

std::vector<double> sampled_statistics(const IdentifyStudy& study, const ResponseVideo& v,
                                       const EpisodeStatistics& statistics, const SampledEpisode& sampled,
                                       const EpisodeSeeds& seeds) {
  const EpisodeObservation seen = simulate_episode(
      read_scenario(sampled.scenario, builtin_parts()), seeds.episode,
      {sampled.timing.lead_s, sampled.direction_deg}, statistics.times_s(), study.look, v.ground);
  std::vector<double> numbers =
      study.look == Look::video ? statistics.of_frames(seen.frames) : statistics.of_positions(seen.positions);
  StudyRandom random(seeds.episode, StudyDraws::measurement);
  statistics.blur(numbers, random);
  return numbers;
}

}  // namespace faba
