#pragma once
#include <Eigen/Core>
#include <functional>
#include <memory>
#include <vector>

#include "study/stats/emulator.h"

namespace faba {

/// Simulations of one model: row i of `u` are the parameters of one, as shares of their ranges (0 to 1), row
/// i of `s` its statistics.
struct SimulationTable {
  Eigen::MatrixXd u, s;
  Eigen::Index size() const { return u.rows(); }
};
/// The rows whose numbers are listed.
SimulationTable rows_of(const SimulationTable& t, const std::vector<Eigen::Index>& rows);

/// How likely what was observed is under parameters (Wood 2010): statistics of a simulation are normally
/// distributed about a mean that depends on the parameters. They are compressed to as many numbers as there
/// are parameters first, the best linear guesses of these near `centre`, whose mean and covariance
/// simulations other than those that chose the compression then tell. That they are estimates makes it
/// Student's t in place of a normal law.
class SyntheticLikelihood {
 public:
  /// `choose`: simulations that the compression rests on; `fit`: those that the likelihood rests on. Both
  /// hold more rows than Emulator::terms(d).
  SyntheticLikelihood(const SimulationTable& choose, const SimulationTable& fit,
                      const Eigen::VectorXd& observed, const Eigen::VectorXd& centre);

  /// Up to a constant.
  double log_likelihood(const Eigen::VectorXd& u) const;
  /// The best linear guess from statistics, relative to the centre.
  Eigen::VectorXd compressed(const Eigen::VectorXd& s) const { return compression_ * (s - at_centre_); }

 private:
  Eigen::MatrixXd compression_;  ///< d x p
  Eigen::VectorXd at_centre_, observed_;
  std::unique_ptr<Emulator> emulator_;
  Eigen::MatrixXd precision_;
};

/// A region of parameters: what lies between the two corners.
struct ParameterBox {
  Eigen::VectorXd low, high;
  bool holds(const Eigen::VectorXd& u) const {
    return (u.array() >= low.array()).all() && (u.array() <= high.array()).all();
  }
};

/// Draws from a density on a box (random-walk Metropolis, its step adapted during a first part that is thrown
/// away): `count` of them, thinned so that neighbours hardly agree. `spread` is a guess at the covariance.
Eigen::MatrixXd sample(const std::function<double(const Eigen::VectorXd&)>& log_density,
                       const ParameterBox& box, const Eigen::VectorXd& start, const Eigen::MatrixXd& spread,
                       int count, std::uint64_t seed);

}  // namespace faba
