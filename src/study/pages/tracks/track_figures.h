#pragma once
#include <vector>

#include "study/pages/run_figures.h"
#include "study/tracks/populations.h"
#include "study/tracks/track_statistics.h"
#include "vision/draw/track_picture.h"

namespace faba {

/// The figures of tracks: distribution of speeds, mean-square displacement with both fits on logarithmic
/// axes, and direction over time. The medians of `populations`, when there are several, replace the mean. In
/// um if `um_per_px` > 0, else in px. A figure without data is omitted.
std::vector<Figure> track_figures(const TrackSummary& summary, double um_per_px,
                                  const std::vector<SpeedPopulation>& populations = {});

/// Plot of the paths in picture coordinates, px, y down.
Plot path_plot(const std::vector<TrackLine>& tracks, int width, int height);

}  // namespace faba
