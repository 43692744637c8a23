#pragma once
#include <cstdint>
#include <functional>
#include <memory>
#include <optional>
#include <vector>

#include "study/identify/synthetic_likelihood.h"

namespace faba {

/// Number of simulations in each round. The last round is repeated, at most twice, when its region truncates
/// the posterior. `of` divides a total number among the rounds.
struct SearchRounds {
  int first = 160;       ///< over the full ranges
  int refinement = 120;  ///< two rounds, around the simulations nearest to the observation
  int last = 200;        ///< over the posterior and its surroundings
  int total() const { return first + 2 * refinement + last; }
  static SearchRounds of(int simulations);
};

/// Estimates the parameters of one model from observed statistics in rounds; each round proposes parameters
/// from the simulations of the previous rounds. Parameters are fractions of their ranges, 0 to 1.
class ParameterSearch {
 public:
  /// Minimum total number of simulations for d parameters.
  static int least_simulations(int d) { return 20 * Emulator::terms(d); }
  using LogPrior = std::function<double(const Eigen::VectorXd&)>;

  /// `d`: number of parameters, 1 to 8. `log_prior`: on the unit cube, up to a constant.
  ParameterSearch(int d, Eigen::VectorXd observed, LogPrior log_prior, SearchRounds rounds,
                  std::uint64_t seed);

  /// Parameters to simulate next, one row for each simulation; empty when the search is finished.
  const std::optional<Eigen::MatrixXd>& next() const { return next_; }
  /// Takes the statistics of those simulations. Rows with non-finite values are failed simulations and are
  /// ignored. Throws Error(input) when too few are left.
  void take(const Eigen::MatrixXd& statistics);

  // After the search:

  /// Samples of the posterior given the listed columns of the statistics (empty: all), count x d.
  Eigen::MatrixXd posterior(const std::vector<Eigen::Index>& columns, int count, std::uint64_t seed) const;
  /// The likelihood of those columns, and the region in which it was sampled.
  SyntheticLikelihood likelihood(const std::vector<Eigen::Index>& columns) const;
  const ParameterBox& box() const { return box_; }
  /// Expected statistics and their noise near the posterior, for predictions.
  const Emulator& emulator() const { return *emulator_; }
  /// Posterior by approximate Bayesian computation from the same simulations: those nearest to the
  /// observation, weighted by prior over proposal, with linear regression adjustment (Beaumont et al. 2002).
  struct WeightedDraws {
    Eigen::MatrixXd u;
    Eigen::VectorXd weight;  ///< sum 1
  };
  WeightedDraws abc_posterior() const;
  const Eigen::VectorXd& observed() const { return observed_; }
  /// Number of rounds, repetitions of the last one included.
  std::size_t rounds() const { return proposals_.size(); }
  /// The valid simulations of all rounds.
  const SimulationTable& simulations() const { return all_; }

 private:
  /// Proposal of a round: mixture of normal distributions with equal covariance at the centres, truncated to
  /// the unit cube; uniform without centres.
  struct Proposal {
    Eigen::MatrixXd centres, covariance;
    Eigen::Index count = 0;
    double density(const Eigen::VectorXd& u) const;
  };
  void propose(Proposal p, int count);
  void fit_emulator();
  bool truncated() const;
  std::vector<Eigen::Index> nearest(Eigen::Index count) const;
  std::vector<Eigen::Index> rows_since(std::size_t round) const;

  int d_;
  std::size_t narrowing_;  ///< number of rounds before the last one
  Eigen::VectorXd observed_;
  LogPrior log_prior_;
  SearchRounds rounds_;
  std::uint64_t seed_;
  SimulationTable all_;
  std::vector<Proposal> proposals_;        ///< of each round
  std::vector<Eigen::Index> round_begin_;  ///< first row of each round in all_
  std::optional<Eigen::MatrixXd> next_;
  ParameterBox box_;
  Eigen::VectorXd centre_;
  Eigen::MatrixXd spread_;
  std::unique_ptr<Emulator> emulator_;
};

}  // namespace faba
