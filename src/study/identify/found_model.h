#pragma once
#include <Eigen/Core>
#include <vector>

#include "study/identify/identification.h"
#include "study/identify/parameter_search.h"

namespace faba {

/// Resolution of the statistics of a video, in pixels per frame or as a fraction; assumed. Deviations that
/// are smaller may come from the measurement, and are then the same in many statistics.
inline constexpr double kStatisticResolution = 0.01;

/// Standard deviation of the noise of each statistic near the posterior, at least their resolution.
Eigen::VectorXd noise_of(const ParameterSearch& search);

/// A model and the predictive samples of each experiment that its scores are based on.
struct ScoredModel {
  FoundModel model;
  std::vector<Eigen::MatrixXd> samples;
};

/// Energy score of samples (rows) against an observation, in units of `scale`, divided by the square root of
/// the number of statistics, so that scores of experiments of different length are comparable (Gneiting and
/// Raftery 2007, eq. 21).
double energy_score(const Eigen::MatrixXd& samples, const Eigen::VectorXd& observed,
                    const Eigen::VectorXd& scale);

/// Result of a finished search: parameters with intervals, goodness of fit, and the energy score of each
/// experiment (the columns of its statistics), predicted from the other experiments. `parts`: their name in
/// sentences, "experiments" or "field segments". `scale`: unit of each statistic in the scores, equal for all
/// models. The caller sets `name` and `failed`.
ScoredModel found_model(const Candidate& candidate, const ParameterSearch& search,
                        const std::vector<std::vector<Eigen::Index>>& experiments, const char* parts,
                        const Eigen::VectorXd& scale, std::uint64_t seed);

}  // namespace faba
