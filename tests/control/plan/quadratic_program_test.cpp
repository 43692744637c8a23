#include <doctest/doctest.h>

#include <Eigen/Dense>

#include "control/plan/quadratic_program.h"

using namespace faba;

namespace {

// Reproducible numbers between -1 and 1.
struct Numbers {
  std::uint64_t state = 1;
  double next() {
    state = state * 6364136223846793005u + 1442695040888963407u;
    return double(state >> 11) * 0x1p-52 - 1;
  }
};

QuadraticProgram random_program(int n, Numbers& r) {
  QuadraticProgram p;
  Eigen::MatrixXd root(n, n);
  for (double& v : root.reshaped()) v = r.next();
  p.hessian = root * root.transpose() + 0.1 * Eigen::MatrixXd::Identity(n, n);
  p.gradient.resize(n);
  for (double& v : p.gradient) v = 5 * r.next();
  p.rows = Eigen::MatrixXd::Identity(n, n);
  return p;
}

}  // namespace

TEST_CASE("quadratic program: without rows it is the solution of the linear system") {
  Numbers r;
  QuadraticProgram p = random_program(6, r);
  p.rows.resize(0, 6);
  const QuadraticSolution s = solve(p, {});
  CHECK(s.converged);
  CHECK((p.hessian * s.x + p.gradient).norm() < 1e-6 * p.gradient.norm());
}

TEST_CASE("quadratic program: a step down the gradient and back into the sets does not move the solution") {
  // The optimality condition of a convex program; independent of the solver.
  Numbers r;
  for (int trial = 0; trial < 50; ++trial) {
    QuadraticProgram p = random_program(8, r);
    for (Eigen::Index i = 0; i < 8; i += 2) {
      QuadraticProgram::Block b;
      b.first = i;
      b.count = 2;
      if (trial % 2 == 0) {
        b.radius = 1;
      } else {
        b.low = -0.5;
        b.high = 0.8;
      }
      p.blocks.push_back(b);
    }
    const QuadraticSolution s = solve(p, {}, 2000, 1e-7);
    REQUIRE(s.converged);
    Eigen::VectorXd stepped = s.x - 0.1 * (p.hessian * s.x + p.gradient);
    for (const auto& b : p.blocks) {
      auto v = stepped.segment(b.first, 2);
      if (b.radius == 1)
        v *= std::min(1.0, 1 / v.norm());
      else
        v = v.cwiseMax(b.low).cwiseMin(b.high);
    }
    CHECK((stepped - s.x).norm() < 1e-4);
    // A program of the same size starts from the solution.
    CHECK(solve(p, s, 2000, 1e-7).iterations <= 20);
  }
}

TEST_CASE("quadratic program: a soft row is violated by what its weight permits") {
  // (x - 1)^2 + w max(0, x)^2 has its minimum at 1 / (1 + w).
  for (const double weight : {0.1, 1.0, 10.0}) {
    QuadraticProgram p;
    p.hessian = Eigen::MatrixXd::Constant(1, 1, 2);
    p.gradient = Eigen::VectorXd::Constant(1, -2);
    p.rows = Eigen::MatrixXd::Identity(1, 1);
    QuadraticProgram::Block b;
    b.high = 0;
    b.weight = weight;
    p.blocks.push_back(b);
    const QuadraticSolution s = solve(p, {}, 5000, 1e-9);
    CHECK(s.x[0] == doctest::Approx(1 / (1 + weight)).epsilon(1e-5));
  }
}
