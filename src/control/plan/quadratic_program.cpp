#include "control/plan/quadratic_program.h"

#include <Eigen/Cholesky>
#include <algorithm>
#include <cmath>

namespace faba {
namespace {

constexpr double kSoft = 1e-6;       // curvature that makes the step unique
constexpr double kRelaxation = 1.6;  // of the step of the rows; typically 1.5 to 1.8 [S65]
constexpr double kSlope = 0.1;       // tolerance of the gradient, relative to that of the rows
constexpr int kCheckEvery = 10;
constexpr double kChange = 3;  // ratio of penalties that is worth another factorisation
constexpr double kLeastPenalty = 1e-6, kLargestPenalty = 1e9;

// The nearest point of the set of a block; with a finite weight, the point that minimises
// weight violation^2 + penalty / 2 (point - v)^2.
void project(const QuadraticProgram::Block& b, double penalty, Eigen::Ref<Eigen::VectorXd> v) {
  Eigen::VectorXd nearest = v;
  if (std::isfinite(b.radius)) {
    const Eigen::VectorXd centre = b.centre.size() > 0 ? b.centre : Eigen::VectorXd::Zero(v.size());
    const double distance = (v - centre).norm();
    if (distance > b.radius) nearest = centre + (b.radius / distance) * (v - centre);
  } else {
    nearest = v.cwiseMax(b.low).cwiseMin(b.high);
  }
  const double share = std::isfinite(b.weight) ? 2 * b.weight / (2 * b.weight + penalty) : 1;
  v += share * (nearest - v);
}

// The same program with rows of length 1, or of at most 1 in a ball, for which one penalty suits all rows.
QuadraticProgram with_unit_rows(QuadraticProgram p) {
  for (auto& b : p.blocks) {
    const double length = p.rows.middleRows(b.first, b.count).rowwise().norm().maxCoeff();
    if (!(length > 0)) continue;
    p.rows.middleRows(b.first, b.count) /= length;
    b.radius /= length;
    b.low /= length;
    b.high /= length;
    b.centre /= length;
    b.weight *= length * length;
  }
  return p;
}

// The iteration: x, the values of the rows in their sets, and the multipliers.
class Iteration {
 public:
  Iteration(const QuadraticProgram& program, const QuadraticSolution& start) : p_(with_unit_rows(program)) {
    const Eigen::Index n = p_.gradient.size(), m = p_.rows.rows();
    const bool warm = start.x.size() == n && start.multipliers.size() == m;
    s.x = warm ? start.x : Eigen::VectorXd::Zero(n);
    s.multipliers = warm ? start.multipliers : Eigen::VectorXd::Zero(m);
    use(std::clamp(p_.hessian.diagonal().mean(), kLeastPenalty, kLargestPenalty));
    values_ = p_.rows * s.x;
    for (const auto& b : p_.blocks) project(b, penalty_, values_.segment(b.first, b.count));
  }

  void step() {
    s.x = factor_.solve(kSoft * penalty_ * s.x - p_.gradient +
                        p_.rows.transpose() * (penalty_ * values_ - s.multipliers));
    reached_ = p_.rows * s.x;
    const Eigen::VectorXd relaxed = kRelaxation * reached_ + (1 - kRelaxation) * values_;
    values_ = relaxed + s.multipliers / penalty_;
    for (const auto& b : p_.blocks) project(b, penalty_, values_.segment(b.first, b.count));
    s.multipliers += penalty_ * (relaxed - values_);
  }

  // Whether the rows are in their sets, and the gradient is zero; adapts the penalty so that both approach
  // zero at the same rate [S65].
  bool check(double tolerance) {
    const Eigen::VectorXd pull = p_.rows.transpose() * s.multipliers, push = p_.hessian * s.x;
    const double outside = largest(reached_ - values_);
    const double slope =
        largest(push + p_.gradient + pull) / std::max({largest(push), largest(p_.gradient), 1e-12});
    if (outside < tolerance && slope < kSlope * tolerance) return true;
    const double scale = std::max({largest(reached_), largest(values_), 1e-12});
    const double change = std::sqrt((outside / scale) / std::max(slope, 1e-12));
    if (change > kChange || change < 1 / kChange)
      use(std::clamp(penalty_ * std::clamp(change, 1e-3, 1e3), kLeastPenalty, kLargestPenalty));
    return false;
  }

  QuadraticSolution s;

 private:
  static double largest(const Eigen::VectorXd& v) { return v.size() > 0 ? v.cwiseAbs().maxCoeff() : 0; }
  void use(double penalty) {
    penalty_ = penalty;
    const Eigen::Index n = p_.gradient.size();
    factor_.compute(p_.hessian + kSoft * penalty * Eigen::MatrixXd::Identity(n, n) +
                    penalty * p_.rows.transpose() * p_.rows);
  }

  QuadraticProgram p_;
  double penalty_ = 1;
  Eigen::LLT<Eigen::MatrixXd> factor_;
  Eigen::VectorXd values_, reached_;
};

}  // namespace

QuadraticSolution solve(const QuadraticProgram& p, const QuadraticSolution& start, int most_iterations,
                        double tolerance) {
  Iteration i(p, start);
  while (i.s.iterations < most_iterations && !i.s.converged) {
    i.step();
    if (++i.s.iterations % kCheckEvery == 0) i.s.converged = i.check(tolerance);
  }
  return i.s;
}

}  // namespace faba
