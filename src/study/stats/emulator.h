#pragma once
#include <Eigen/Core>

namespace faba {

/// Statistics of simulations as functions of parameters: a quadratic polynomial fitted by least squares to
/// each, with the residuals as noise. Valid near the centre of the fitted points only.
class Emulator {
 public:
  /// Row i of `u` (n x d) has the parameters of a simulation, row i of `s` (n x p) its statistics. n must be
  /// larger than terms(d).
  Emulator(const Eigen::MatrixXd& u, const Eigen::MatrixXd& s);

  /// Number of coefficients of the polynomial of d parameters.
  static int terms(int d) { return 1 + d + d * (d + 1) / 2; }
  /// Expected statistics, p.
  Eigen::VectorXd mean(const Eigen::VectorXd& u) const;
  /// Derivatives of mean() with respect to the parameters, p x d.
  Eigen::MatrixXd slope(const Eigen::VectorXd& u) const;
  /// Variance of mean() relative to that of the noise, which a prediction adds to it.
  double leverage(const Eigen::VectorXd& u) const;
  /// Residuals of the simulations, n x p, scaled to the variance of the noise.
  const Eigen::MatrixXd& residuals() const { return residuals_; }
  /// Covariance of the noise, p x p, from the residuals.
  Eigen::MatrixXd covariance() const;
  int freedom() const { return freedom_; }  ///< n - terms(d)

 private:
  Eigen::VectorXd basis(const Eigen::VectorXd& u) const;
  Eigen::VectorXd middle_, width_;  ///< of the points; the polynomial is a function of (u - middle) / width
  Eigen::MatrixXd coefficients_, residuals_, normal_inverse_;
  int freedom_ = 0;
};

/// A covariance of p statistics with `freedom` degrees of freedom, regularised for inversion: correlations
/// are shrunk by p / (p + freedom), at least 1 %.
Eigen::MatrixXd shrunk(const Eigen::MatrixXd& covariance, int freedom);

}  // namespace faba
