#pragma once
#include <Eigen/Core>
#include <vector>

#include "study/identify/families/model_family.h"
#include "study/identify/statistics/observed_statistics.h"
#include "study/sweep/sweep.h"

namespace faba {

/// Scenario of an episode for a candidate at parameters `u`, as fractions of their ranges.
Document candidate_scenario(const IdentifyStudy& study, const Candidate& c, const ResponseVideo& v,
                            const Episode& e, const Eigen::VectorXd& u, const SegmentTiming& timing);

/// The simulations of one round, as tasks. Each simulation samples what is known with an uncertainty: times
/// of field reversals, number of cells, scale and field strength.
class SimulationRound {
 public:
  SimulationRound(const IdentifyStudy& study, const std::vector<ResponseVideo>& videos,
                  const ObservedStatistics& observed);

  /// Adds simulations of candidate `candidate`, one for each row of `u` and each episode. Simulations of one
  /// `number` and candidate have the same random numbers with and without a family.
  void add(std::size_t candidate, const Eigen::MatrixXd& u, std::size_t number,
           const ModelFamily* family = nullptr);
  bool empty() const { return tasks_.empty(); }
  /// False when other shards have tasks left. Throws the errors of sweep().
  bool run(ResultStore& results, const SweepOptions& options) { return sweep(results, tasks_, options); }
  /// Statistics of the simulations of the next add(), one row each; NaN for failed simulations. Throws
  /// Error(usage) for damaged results.
  Eigen::MatrixXd take(const ResultStore& results, Eigen::Index rows);

 private:
  void add_one(std::size_t candidate, const Eigen::VectorXd& u, std::size_t number, Eigen::Index i,
               std::size_t p, const ModelFamily* family);
  const IdentifyStudy& study_;
  const std::vector<ResponseVideo>& videos_;
  const ObservedStatistics& observed_;
  std::string observed_digest_;
  std::vector<Task> tasks_;
  std::size_t taken_ = 0;
};

}  // namespace faba
