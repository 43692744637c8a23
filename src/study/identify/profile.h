#pragma once
#include <Eigen/Core>
#include <functional>

#include "study/identify/synthetic_likelihood.h"

namespace faba {

/// Profile likelihood of one parameter: the log-likelihood at each of its values, maximised over the other
/// parameters.
struct Profile {
  Eigen::VectorXd u;               ///< equidistant values within the box
  Eigen::VectorXd log_likelihood;  ///< relative to the maximum, which is 0
};

/// Profile of parameter `j` at `points` values. The other parameters are optimised within the box, starting
/// at `start` (NLopt's Subplex, which is derivative-free and deterministic).
Profile profile_likelihood(const std::function<double(const Eigen::VectorXd&)>& log_likelihood,
                           const ParameterBox& box, const Eigen::VectorXd& start, Eigen::Index j, int points);

}  // namespace faba
