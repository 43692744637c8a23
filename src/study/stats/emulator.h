#pragma once
#include <Eigen/Core>

namespace faba {

/// Statistics of simulations as functions of parameters: each a polynomial of second degree by least squares,
/// and what is left over as noise. Good near the middle of the points it was made from, and nowhere else.
class Emulator {
 public:
  /// Row i of `u` (n x d) are the parameters of a simulation, row i of `s` (n x p) its statistics. n must be
  /// more than terms(d).
  Emulator(const Eigen::MatrixXd& u, const Eigen::MatrixXd& s);

  /// Coefficients of the polynomial of d parameters.
  static int terms(int d) { return 1 + d + d * (d + 1) / 2; }
  /// Expected statistics, p.
  Eigen::VectorXd mean(const Eigen::VectorXd& u) const;
  /// Their change with each parameter, p x d.
  Eigen::MatrixXd slope(const Eigen::VectorXd& u) const;
  /// How much the variance of a new simulation about mean() is larger than that of the noise, as a share of
  /// it: the polynomial is an estimate.
  double leverage(const Eigen::VectorXd& u) const;
  /// What is left over of each simulation, n x p, scaled to the variance of the noise.
  const Eigen::MatrixXd& residuals() const { return residuals_; }
  /// Covariance of the noise, p x p, from the residuals.
  Eigen::MatrixXd covariance() const;
  int freedom() const { return freedom_; }  ///< n - terms(d)

 private:
  Eigen::VectorXd basis(const Eigen::VectorXd& u) const;
  Eigen::VectorXd middle_, width_;  ///< of the points: the polynomial is of (u - middle) / width
  Eigen::MatrixXd coefficients_, residuals_, normal_inverse_;
  int freedom_ = 0;
};

/// A covariance of p statistics from few simulations (`freedom`), made safe to invert: correlations are
/// shrunk by p / (p + freedom), at least 1 %.
Eigen::MatrixXd shrunk(const Eigen::MatrixXd& covariance, int freedom);

}  // namespace faba
