#pragma once
#include <Eigen/Core>
#include <functional>
#include <vector>

#include "study/identify/families/model_family.h"

namespace faba {

/// Renders the videos of an experiment with parameters `u` of a candidate, with the illumination, noise and
/// initial positions of the measured videos `design`, and measures them like videos of a study. The videos
/// are in a temporary folder, which is removed. `difference`: how the experiment differs from the candidate.
/// Throws Error(usage) for incompatible parameters, Error(input) for videos that cannot be measured.
std::vector<ResponseVideo> rendered_experiment(const IdentifyStudy& study, const Candidate& c,
                                               const std::vector<ResponseVideo>& design,
                                               const Eigen::VectorXd& u, std::uint64_t seed,
                                               const ModelFamily& difference,
                                               const std::function<void()>& tick);

}  // namespace faba
