#include "study/identify/statistics/episode.h"

namespace faba {

std::unique_ptr<EpisodeStatistics> make_statistics(Measure measure, const Episode& episode,
                                                   const CellView& view) {
  return measure == Measure::density ? density_statistics(episode, view) : burst_statistics(episode, view);
}

}  // namespace faba
