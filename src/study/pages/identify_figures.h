#pragma once
#include <vector>

#include "study/identify/identify.h"
#include "study/plot/figure.h"

namespace faba {

/// What was observed and what the best model shows again and again: over time where the swarm is and how much
/// of it is in view, or segment by segment how fast cells go.
std::vector<Figure> predictive_figures(const Identification& result);

/// The posterior of a parameter and its profile.
Figure posterior_figure(const FoundParameter& parameter);
Figure profile_figure(const FoundParameter& parameter);

/// The thesis's rule for one model: distances of its simulations over the frames (Fig. 3.31), and their
/// slopes against the parameter (Figs. 3.32, 4.14 to 4.16).
std::vector<Figure> legacy_figures(const LegacyModel& model);

/// A segment of an episode as it was and as it is simulated, and how cells are spread along it.
struct EpisodePictures {
  std::string name;
  std::vector<double> t_s;  ///< from the episode's beginning
  std::vector<GrayF> real, simulated;
  Figure spread;
};
/// Of the first episodes; simulates them with the best model.
std::vector<EpisodePictures> episode_pictures(const Identification& result);

}  // namespace faba
