#pragma once
#include <cstdint>
#include <functional>
#include <memory>
#include <optional>
#include <vector>

#include "study/identify/synthetic_likelihood.h"

namespace faba {

/// How many simulations each round makes. The last one is made again, twice at most, when the posterior turns
/// out to reach beyond it.
/// `of` makes them of a number in all.
struct SearchRounds {
  int first = 160;   ///< all over the ranges
  int closer = 120;  ///< twice, around those that come nearest to what was observed
  int last = 200;    ///< over the posterior and its surroundings
  int total() const { return first + 2 * closer + last; }
  static SearchRounds of(int simulations);
};

/// Finds the parameters of one model from what was observed, in rounds: each proposes parameters from what
/// the simulations of the rounds before have shown. Parameters are shares of their ranges, 0 to 1.
class ParameterSearch {
 public:
  /// Of all rounds together, for d parameters.
  static int least_simulations(int d) { return 20 * Emulator::terms(d); }
  using LogPrior = std::function<double(const Eigen::VectorXd&)>;

  /// d parameters, 1 to 8; `log_prior` up to a constant, on the unit cube.
  ParameterSearch(int d, Eigen::VectorXd observed, LogPrior log_prior, SearchRounds rounds,
                  std::uint64_t seed);

  /// Parameters to simulate next, one row for each simulation; empty when the search is over.
  const std::optional<Eigen::MatrixXd>& next() const { return next_; }
  /// The statistics of those simulations. Rows that are not all numbers are simulations that could not be
  /// done, and are left out. Throws Error(input) when too few are left.
  void take(const Eigen::MatrixXd& statistics);

  // When it is over:

  /// Draws from the posterior given the columns listed of the statistics (empty: all), count x d.
  Eigen::MatrixXd posterior(const std::vector<Eigen::Index>& columns, int count, std::uint64_t seed) const;
  /// The likelihood on those columns, and where it was sampled.
  SyntheticLikelihood likelihood(const std::vector<Eigen::Index>& columns) const;
  const ParameterBox& box() const { return box_; }
  /// Expected statistics and their noise near the posterior: for what a model predicts.
  const Emulator& emulator() const { return *emulator_; }
  /// Posterior by another way, from the same simulations: those nearest to what was observed, weighed by
  /// prior over proposal and brought to it by linear regression (approximate Bayesian computation, Beaumont
  /// et al. 2002).
  struct WeighedDraws {
    Eigen::MatrixXd u;
    Eigen::VectorXd weight;  ///< sum 1
  };
  WeighedDraws by_distance() const;
  const Eigen::VectorXd& observed() const { return observed_; }
  /// Of all rounds.
  const SimulationTable& simulations() const { return all_; }

 private:
  /// What a round drew from: normal laws about its centres, all alike, cut off at the cube. None: uniform.
  struct Proposal {
    Eigen::MatrixXd centres, covariance;
    Eigen::Index count = 0;
    double density(const Eigen::VectorXd& u) const;
  };
  void propose(Proposal p, int count);
  void conclude();
  bool cut_off() const;
  std::vector<Eigen::Index> nearest(Eigen::Index count) const;
  std::vector<Eigen::Index> rows_since(std::size_t round) const;

  int d_;
  Eigen::VectorXd observed_;
  LogPrior log_prior_;
  SearchRounds rounds_;
  std::uint64_t seed_;
  SimulationTable all_;
  std::vector<Proposal> proposals_;        ///< of each round so far
  std::vector<Eigen::Index> round_begin_;  ///< rows of all_
  std::optional<Eigen::MatrixXd> next_;
  ParameterBox box_;
  Eigen::VectorXd centre_;
  Eigen::MatrixXd spread_;
  std::unique_ptr<Emulator> emulator_;
};

}  // namespace faba
