#include "study/stats/emulator.h"

#include <Eigen/Dense>
#include <algorithm>
#include <cmath>

namespace faba {

Emulator::Emulator(const Eigen::MatrixXd& u, const Eigen::MatrixXd& s) {
  const Eigen::Index n = u.rows(), d = u.cols();
  middle_ = u.colwise().mean();
  width_ = ((u.rowwise() - middle_.transpose()).colwise().squaredNorm() / double(n)).cwiseSqrt();
  width_ = width_.cwiseMax(1e-12);
  Eigen::MatrixXd basis_of(n, terms(int(d)));
  for (Eigen::Index i = 0; i < n; ++i) basis_of.row(i) = basis(u.row(i).transpose()).transpose();
  const Eigen::ColPivHouseholderQR<Eigen::MatrixXd> qr(basis_of);
  coefficients_ = qr.solve(s);
  freedom_ = int(n) - terms(int(d));
  residuals_ = (s - basis_of * coefficients_) * std::sqrt(double(n) / freedom_);
  normal_inverse_ = (basis_of.transpose() * basis_of).inverse();
}

// 1, z, and all products of two elements of z.
Eigen::VectorXd Emulator::basis(const Eigen::VectorXd& u) const {
  const Eigen::VectorXd z = (u - middle_).cwiseQuotient(width_);
  const Eigen::Index d = z.size();
  Eigen::VectorXd b(terms(int(d)));
  b[0] = 1;
  b.segment(1, d) = z;
  Eigen::Index k = 1 + d;
  for (Eigen::Index i = 0; i < d; ++i)
    for (Eigen::Index j = i; j < d; ++j) b[k++] = z[i] * z[j];
  return b;
}

Eigen::VectorXd Emulator::mean(const Eigen::VectorXd& u) const {
  return coefficients_.transpose() * basis(u);
}

Eigen::MatrixXd Emulator::slope(const Eigen::VectorXd& u) const {
  const Eigen::VectorXd z = (u - middle_).cwiseQuotient(width_);
  const Eigen::Index d = z.size();
  Eigen::MatrixXd db = Eigen::MatrixXd::Zero(coefficients_.rows(), d);
  for (Eigen::Index i = 0; i < d; ++i) db(1 + i, i) = 1;
  Eigen::Index k = 1 + d;
  for (Eigen::Index i = 0; i < d; ++i)
    for (Eigen::Index j = i; j < d; ++j, ++k) {
      db(k, i) += z[j];
      db(k, j) += z[i];
    }
  return coefficients_.transpose() * db * width_.cwiseInverse().asDiagonal();
}

double Emulator::leverage(const Eigen::VectorXd& u) const {
  const Eigen::VectorXd b = basis(u);
  return b.dot(normal_inverse_ * b);
}

Eigen::MatrixXd Emulator::covariance() const {
  return residuals_.transpose() * residuals_ / double(residuals_.rows());
}

Eigen::MatrixXd shrunk(const Eigen::MatrixXd& covariance, int freedom) {
  const double p = double(covariance.rows());
  const double shrinkage = std::max(0.01, p / (p + freedom));
  Eigen::MatrixXd out = (1 - shrinkage) * covariance;
  out.diagonal() = covariance.diagonal();
  return out;
}

}  // namespace faba
