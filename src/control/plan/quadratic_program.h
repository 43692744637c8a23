#pragma once
#include <Eigen/Core>
#include <limits>
#include <vector>

namespace faba {

/// minimise x^T hessian x / 2 + gradient^T x, with rows x in the set of each of `blocks`.
///
/// Solved by the alternating direction method of multipliers [S65] with a fixed number of iterations at most,
/// so that a cycle of a control loop has an upper bound of time. Scale the variables and rows to a size of
/// about 1.
struct QuadraticProgram {
  /// Consecutive rows whose values must be in a ball, or each in an interval.
  struct Block {
    Eigen::Index first = 0, count = 1;
    double radius = std::numeric_limits<double>::infinity();  ///< of a ball around `centre`
    double low = -std::numeric_limits<double>::infinity(), high = std::numeric_limits<double>::infinity();
    Eigen::VectorXd centre = {};  ///< empty: zero
    /// Weight of the squared violation; infinity: the block must hold.
    double weight = std::numeric_limits<double>::infinity();
  };
  Eigen::MatrixXd hessian, rows;
  Eigen::VectorXd gradient;
  std::vector<Block> blocks;
};

/// The point from which a solution starts, and its multipliers: of a program of the same size.
struct QuadraticSolution {
  Eigen::VectorXd x;
  Eigen::VectorXd multipliers;
  int iterations = 0;
  bool converged = false;  ///< the rows are in their sets, and the gradient is zero, to the tolerance
};
QuadraticSolution solve(const QuadraticProgram& p, const QuadraticSolution& start, int most_iterations = 400,
                        double tolerance = 1e-3);

}  // namespace faba
