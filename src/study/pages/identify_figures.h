#pragma once
#include <vector>

#include "study/identify/identify.h"
#include "study/plot/figure.h"

namespace faba {

/// Observed statistics and posterior predictive intervals of the best model: position and signal of the swarm
/// over time, or velocity of the cells in each segment.
std::vector<Figure> predictive_figures(const Identification& result);

/// Posterior of a parameter, and its profile likelihood. `parts`: what the bootstrap resamples.
Figure posterior_figure(const FoundParameter& parameter, const std::string& parts);
Figure profile_figure(const FoundParameter& parameter);

/// Selection rule of the thesis for one model: distances of its simulations over the frames (Fig. 3.31), and
/// their slopes against the parameter (Figs. 3.32, 4.14 to 4.16).
std::vector<Figure> legacy_figures(const LegacyModel& model);

/// Frames of an episode and of its simulation, and the distribution of the cells along the first segment.
struct EpisodePictures {
  std::string name;
  std::vector<double> t_s;  ///< relative to the start of the episode
  std::vector<GrayF> real, simulated;
  Figure distribution;
};
/// Pictures of the first two episodes, simulated with the best model.
std::vector<EpisodePictures> episode_pictures(const Identification& result);

}  // namespace faba
