#pragma once
#include <Eigen/Core>
#include <vector>

#include "study/identify/identification.h"
#include "study/identify/parameter_search.h"

namespace faba {

/// Standard deviation of the noise of each statistic near the posterior, at least 0.01.
Eigen::VectorXd noise_of(const ParameterSearch& search);

/// Result of a finished search: parameters with intervals, goodness of fit, and the energy score of each
/// experiment (the columns of its statistics), predicted from the other experiments. `parts`: their name in
/// sentences, "experiments" or "field segments". `scale`: unit of each statistic in the scores, equal for all
/// models. The caller sets `name` and `failed`.
FoundModel found_model(const Candidate& candidate, const ParameterSearch& search,
                       const std::vector<std::vector<Eigen::Index>>& experiments, const char* parts,
                       const Eigen::VectorXd& scale, std::uint64_t seed);

/// Selects the best model and rates the evidence for it. Throws Error(input) if no model could be identified.
void judge(Identification& result);

}  // namespace faba
