#pragma once
#include "study/identify/parameter_search.h"

namespace faba {

/// A search that is over: `simulate` gives the statistics at parameters.
template <class Simulate>
ParameterSearch searched(int d, const Eigen::VectorXd& observed, std::uint64_t seed, Simulate&& simulate,
                         SearchRounds rounds = {}) {
  ParameterSearch s(
      d, observed, [](const Eigen::VectorXd&) { return 0.0; }, rounds, seed);
  while (s.next()) {
    const Eigen::MatrixXd u = *s.next();
    Eigen::MatrixXd statistics(u.rows(), observed.size());
    for (Eigen::Index i = 0; i < u.rows(); ++i)
      statistics.row(i) = simulate(Eigen::VectorXd(u.row(i))).transpose();
    s.take(statistics);
  }
  return s;
}

}  // namespace faba
