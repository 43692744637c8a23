#pragma once
#include <Eigen/Core>
#include <vector>

namespace faba {

/// How simulations of a model differ from observed statistics: everything that score tests need.
struct ModelPrediction {
  Eigen::MatrixXd simulated;   ///< posterior predictive simulations, one row each
  Eigen::MatrixXd slope;       ///< derivatives of the statistics with respect to the parameters (p x d)
  Eigen::MatrixXd covariance;  ///< noise of the statistics (p x p)
  int freedom = 1;             ///< degrees of freedom of the covariance
};

/// Result of a score test.
struct ScoreTest {
  double amount = 0, sd = 0;  ///< estimated amount of a change of the model, in units of that change
  double t = 0, p = 1;        ///< Student's t and its p-value
  double explained = 0;       ///< fraction of the squared deviation, in units of noise, that it removes
  double effect = 0;          ///< largest change of a statistic by this amount
};

/// Score test (Rao 1948) of a change of the model that shifts the statistics by `change`, when all parameters
/// of the model may adapt: the component of `change` that the parameters cannot produce is compared with the
/// deviation of the observation from the predictive simulations. These simulations, which did not determine
/// the weights, give the distribution for a model that is right.
ScoreTest score_test(const ModelPrediction& model, const Eigen::VectorXd& observed,
                     const Eigen::VectorXd& change, bool two_sided);

/// Shift of the predicted statistics `columns` when the amount of the change is estimated from the statistics
/// `others`.
Eigen::VectorXd predicted_shift(const ModelPrediction& model, const Eigen::VectorXd& observed,
                                const Eigen::VectorXd& change, bool two_sided,
                                const std::vector<Eigen::Index>& others,
                                const std::vector<Eigen::Index>& columns);

}  // namespace faba
