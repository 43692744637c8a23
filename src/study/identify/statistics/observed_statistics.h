#pragma once
#include <Eigen/Core>
#include <memory>
#include <string>
#include <vector>

#include "study/identify/identification.h"
#include "study/identify/response_video.h"

namespace faba {

/// Statistics of all videos in one list, and their division into experiments. With one experiment, its field
/// segments take the role of experiments.
struct ObservedStatistics {
  /// An episode of a video and the columns of its statistics in the list of all statistics.
  struct Part {
    std::size_t video = 0, episode = 0;
    Eigen::Index begin = 0, count = 0;
    std::shared_ptr<const EpisodeStatistics> statistics;
  };
  std::vector<Part> parts;
  Eigen::VectorXd numbers;
  std::vector<Identification::Statistic> statistics;
  std::vector<std::string> experiments;
  std::vector<std::vector<Eigen::Index>> columns;  ///< of each experiment
  const char* parts_name = "experiments";          ///< "field segments" when these take their role
};

ObservedStatistics observed_statistics(const std::vector<ResponseVideo>& videos);

}  // namespace faba
