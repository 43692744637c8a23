#pragma once
#include <array>
#include <cstdint>
#include <vector>

#include "study/identify/parameter_search.h"

namespace faba {

/// Between which values 90 % of the estimates of each parameter lie when the experiments are drawn anew with
/// replacement (cluster bootstrap), as shares of their ranges: wider than the posterior where experiments
/// differ by more than the chance that a model knows of. Each experiment is the columns of its statistics.
/// Estimates are one Newton step from `centre`, which is near the best, on the sum of the experiments' own
/// log-likelihoods. Empty for fewer than three experiments, which have too few ways to be drawn.
std::vector<std::array<double, 2>> resampled_estimates(
    const ParameterSearch& search, const std::vector<std::vector<Eigen::Index>>& experiments,
    const Eigen::VectorXd& centre, const Eigen::VectorXd& sd, std::uint64_t seed);

}  // namespace faba
