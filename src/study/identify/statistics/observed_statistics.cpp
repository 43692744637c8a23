#include "study/identify/statistics/observed_statistics.h"

#include <fmt/format.h>

#include <algorithm>

namespace faba {

using Eigen::Index;
using Eigen::VectorXd;

ObservedStatistics observed_statistics(const std::vector<ResponseVideo>& videos) {
  ObservedStatistics o;
  std::vector<double> numbers;
  std::vector<std::string> experiment, segment;  // of each statistic
  for (std::size_t v = 0; v < videos.size(); ++v)
    for (std::size_t e = 0; e < videos[v].episodes.size(); ++e) {
      const ResponseVideo& video = videos[v];
      const auto& statistics = video.statistics[e];
      const std::string name =
          video.input.experiment.empty() ? fmt::format("video {}", v + 1) : video.input.experiment;
      o.parts.push_back({v, e, Index(numbers.size()), Index(video.observed[e].size()), statistics});
      for (std::size_t k = 0; k < video.observed[e].size(); ++k) {
        numbers.push_back(video.observed[e][k]);
        const EpisodeStatistics::Number& n = statistics->numbers()[k];
        const bool several = videos.size() > 1 || video.episodes.size() > 1;
        o.statistics.push_back(
            {fmt::format("{}segment {}, {:.3g} s: {}", several ? video.episodes[e].name + ": " : "",
                         n.segment + 1, n.t_s, n.what),
             v, e, n, video.observed[e][k]});
        experiment.push_back(name);
        segment.push_back(fmt::format("{}, segment {}", name, e + n.segment + 1));
      }
    }
  const bool one =
      std::all_of(experiment.begin(), experiment.end(), [&](const auto& x) { return x == experiment[0]; });
  const auto& label = one ? segment : experiment;
  if (one) o.parts_name = "field segments";
  for (std::size_t k = 0; k < numbers.size(); ++k) {
    const auto at = std::find(o.experiments.begin(), o.experiments.end(), label[k]);
    const auto i = std::size_t(at - o.experiments.begin());
    if (at == o.experiments.end()) {
      o.experiments.push_back(label[k]);
      o.columns.emplace_back();
    }
    o.columns[i].push_back(Index(k));
  }
  o.numbers = Eigen::Map<VectorXd>(numbers.data(), Index(numbers.size()));
  return o;
}

}  // namespace faba
