#pragma once
#include <array>
#include <cstdint>
#include <vector>

#include "study/identify/parameter_search.h"

namespace faba {

/// 90 % bootstrap interval of each parameter, as fractions of its range: experiments are resampled with
/// replacement (cluster bootstrap). It is wider than the posterior when experiments differ by more than the
/// randomness of the model. Each experiment is given by the columns of its statistics. An estimate is one
/// Newton step from `centre`, a point near the maximum, on the sum of the log-likelihoods of the experiments.
/// Empty for fewer than three experiments.
std::vector<std::array<double, 2>> resampled_estimates(
    const ParameterSearch& search, const std::vector<std::vector<Eigen::Index>>& experiments,
    const Eigen::VectorXd& centre, const Eigen::VectorXd& sd, std::uint64_t seed);

/// Whether the interval over resampled experiments is so much wider than that of the posterior that the
/// experiments differ. Their positions may differ at random: a median just outside of the bootstrap interval
/// does not show a difference.
bool experiments_differ(const std::array<double, 2>& resampled90, const std::array<double, 2>& ci90);

}  // namespace faba
