#pragma once
#include <vector>

#include "study/identify/found_model.h"
#include "study/identify/statistics/observed_statistics.h"
#include "study/sweep/sweep.h"

namespace faba {

/// Everything that is known about a candidate after its search.
struct SearchedModel {
  const ParameterSearch* search = nullptr;  ///< null for a failed search
  FoundModel* found = nullptr;
  std::vector<Eigen::MatrixXd> samples = {};  ///< predictive samples of each experiment
};

/// Simulates the posterior prediction of each model and of each of its families, and tests the families: sets
/// predicted90, families, extension and extended_scores. `scale` as in found_model(). False when other shards
/// have tasks left.
bool check_families(const IdentifyStudy& study, const std::vector<ResponseVideo>& videos,
                    const ObservedStatistics& observed, std::vector<SearchedModel>& models,
                    const Eigen::VectorXd& scale, ResultStore& results, const SweepOptions& options);

}  // namespace faba
