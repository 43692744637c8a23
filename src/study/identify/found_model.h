#pragma once
#include <Eigen/Core>
#include <vector>

#include "study/identify/identification.h"
#include "study/identify/parameter_search.h"

namespace faba {

/// Standard deviation of the noise of each statistic near the posterior, > 0.
Eigen::VectorXd noise_of(const ParameterSearch& search);

/// What a search that is over has found: parameters with intervals, how well the model fits, and its energy
/// score for each experiment (the columns of its statistics), predicted from the others. `scale`: what the
/// statistics are measured in for the scores, the same for all models. Name and failure are left to the
/// caller.
FoundModel found_model(const Candidate& candidate, const ParameterSearch& search,
                       const std::vector<std::vector<Eigen::Index>>& experiments,
                       const Eigen::VectorXd& scale, std::uint64_t seed);

/// Which of the result's models is best, and how sure that is. Throws Error(input) when none could be
/// identified.
void judge(Identification& result);

}  // namespace faba
