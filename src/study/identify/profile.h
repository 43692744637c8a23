#pragma once
#include <Eigen/Core>
#include <functional>

#include "study/identify/synthetic_likelihood.h"

namespace faba {

/// How well one parameter is told apart from the others: the largest log-likelihood that these can give it at
/// each of its values.
struct Profile {
  Eigen::VectorXd u;               ///< evenly over the box
  Eigen::VectorXd log_likelihood;  ///< relative to the largest; 0 at best
};

/// Of parameter `j` at `points` values. The others begin at `start` and are sought inside the box (NLopt's
/// Subplex, which takes no derivatives and is the same in each run).
Profile profile_likelihood(const std::function<double(const Eigen::VectorXd&)>& log_likelihood,
                           const ParameterBox& box, const Eigen::VectorXd& start, Eigen::Index j, int points);

}  // namespace faba
