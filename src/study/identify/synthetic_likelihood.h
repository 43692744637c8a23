#pragma once
#include <Eigen/Core>
#include <functional>
#include <memory>
#include <vector>

#include "study/stats/emulator.h"

namespace faba {

/// Simulations of one model: row i of `u` holds the parameters of simulation i as fractions of their ranges
/// (0 to 1), row i of `s` its statistics.
struct SimulationTable {
  Eigen::MatrixXd u, s;
  Eigen::Index size() const { return u.rows(); }
};
/// The listed rows.
SimulationTable rows_of(const SimulationTable& t, const std::vector<Eigen::Index>& rows);

/// Synthetic likelihood (Wood 2010): the statistics of a simulation are normally distributed about a mean
/// that depends on the parameters. The statistics are first compressed to one number for each parameter, its
/// best linear estimate near `centre`. The compression of a simulation is fitted to the other simulations
/// (cross-fitting in five folds), because a compression that knows the noise of a simulation underestimates
/// it. The uncertainty of mean and covariance of the compressed statistics gives Student's t distribution
/// instead of a normal one.
class SyntheticLikelihood {
 public:
  /// `fit`: simulations of the likelihood and of the compression, more than 1.25 Emulator::terms(d) rows;
  /// `more`: further simulations of the compression, may be empty.
  SyntheticLikelihood(const SimulationTable& fit, const SimulationTable& more,
                      const Eigen::VectorXd& observed, const Eigen::VectorXd& centre);

  /// Log-likelihood at `u`, up to a constant.
  double log_likelihood(const Eigen::VectorXd& u) const;
  /// Best linear estimate of the parameters from statistics, relative to the centre.
  Eigen::VectorXd compressed(const Eigen::VectorXd& s) const { return compression_ * s - at_centre_; }

 private:
  Eigen::MatrixXd compression_;  ///< d x p, mean of the folds
  Eigen::VectorXd at_centre_;    ///< compressed statistics that are expected at the centre
  Eigen::VectorXd observed_;
  std::unique_ptr<Emulator> emulator_;
  Eigen::MatrixXd precision_;
};

/// A rectangular region of the parameters.
struct ParameterBox {
  Eigen::VectorXd low, high;
  bool contains(const Eigen::VectorXd& u) const {
    return (u.array() >= low.array()).all() && (u.array() <= high.array()).all();
  }
};

/// Samples a density on a box by random-walk Metropolis. The step is adapted during the burn-in, which is
/// discarded; the chain is thinned to reduce autocorrelation. Returns `count` samples. `spread`: initial
/// estimate of the covariance.
Eigen::MatrixXd sample(const std::function<double(const Eigen::VectorXd&)>& log_density,
                       const ParameterBox& box, const Eigen::VectorXd& start, const Eigen::MatrixXd& spread,
                       int count, std::uint64_t seed);

}  // namespace faba
