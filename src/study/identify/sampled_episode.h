#pragma once
#include <Eigen/Core>
#include <cstdint>
#include <vector>

#include "study/identify/families/model_family.h"

namespace faba {

/// Scenario of an episode for a candidate at parameters `u`, as fractions of their ranges.
Document candidate_scenario(const IdentifyStudy& study, const Candidate& c, const ResponseVideo& v,
                            const Episode& e, const Eigen::VectorXd& u, const SegmentTiming& timing);

/// Seeds of a simulation of an episode.
struct EpisodeSeeds {
  std::uint64_t simulation = 0;  ///< of all episodes of one simulation: errors of scale and field strength
  std::uint64_t episode = 0;
};

/// Scenario and times of a simulation of an episode.
struct SampledEpisode {
  Document scenario;
  SegmentTiming timing;
  double direction_deg = 0;  ///< of the first segment
};

/// Samples everything that is known with an uncertainty only: times of field reversals, number of cells,
/// scale and field strength. `change`: how the simulation differs from the candidate; null for no difference.
SampledEpisode sampled_episode(const IdentifyStudy& study, const Candidate& c, const ResponseVideo& v,
                               const Episode& e, const Eigen::VectorXd& u, const EpisodeSeeds& seeds,
                               const ModelFamily* change);

/// Statistics of a sampled simulation with their model error. Throws Error(usage) for parameters that are not
/// compatible.
std::vector<double> sampled_statistics(const IdentifyStudy& study, const ResponseVideo& v,
                                       const EpisodeStatistics& statistics, const SampledEpisode& sampled,
                                       const EpisodeSeeds& seeds);

}  // namespace faba
