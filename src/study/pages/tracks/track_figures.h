#pragma once
#include <vector>

#include "study/pages/run_figures.h"
#include "study/tracks/track_statistics.h"
#include "vision/draw/track_picture.h"

namespace faba {

/// The figures of tracks: distribution of speeds, mean-square displacement with both fits on logarithmic
/// scales, and direction over time. In um where `um_per_px` > 0, else in px. One is left out when there is
/// nothing to show.
std::vector<Figure> track_figures(const TrackSummary& summary, double um_per_px);

/// The paths in the picture, px, y down, without the picture.
Plot path_plot(const std::vector<TrackLine>& tracks, int width, int height);

}  // namespace faba
