#pragma once
#include <array>
#include <optional>
#include <string>
#include <vector>

#include "study/identify/identify_study.h"
#include "study/stats/statistics.h"

namespace faba {

/// What was found of one parameter.
struct FoundParameter {
  FreeParameter parameter;
  double median = 0;
  std::array<double, 2> ci90{};
  double abc_median = 0;  ///< by approximate Bayesian computation, from the same simulations
  std::array<double, 2> abc_ci90{};
  /// Where 90 % of its estimates lie with experiments drawn anew; empty for fewer than three.
  std::optional<std::array<double, 2>> resampled90 = {};
  /// Share of its prior range that the interval covers: near 0.9 nothing was learnt.
  double fraction_of_range = 1;
  std::vector<double> draws = {};
  /// Largest log-likelihood that the other parameters can give each value, relative to the best.
  std::vector<double> profile_at = {}, profile = {};
  std::string doubt = {};  ///< why it could not be told, or only together with another; empty when it could
};

/// What was found of one candidate.
struct FoundModel {
  std::string name;
  std::string failed;  ///< why it could not be identified; empty when it could
  std::vector<FoundParameter> parameters;
  double score = 0;            ///< mean of the energy scores
  std::vector<double> scores;  ///< of each experiment, predicted from the others; less is better
  /// How often simulations of this model are as far from their own mean as what was observed: small values
  /// say that the model does not explain the videos.
  double fit_p = 0;
  std::vector<double> predicted, predicted_sd;  ///< statistics at the posterior
  /// Of the best model: where 90 % of the simulations at draws from the posterior have them.
  std::vector<std::array<double, 2>> predicted90 = {};
  std::size_t simulations = 0;
  Json best;  ///< values of the parameters at the posterior's median, by path
};

/// One simulation against one segment of a video, as the thesis compared them.
struct LegacySimulation {
  double value = 0;  ///< of the parameter
  std::size_t video = 0, episode = 0, repeat = 0;
  std::vector<double> distance;  ///< of each pair of frames
  LineFit line;                  ///< of it against the number of the frame
  double mean = 0;
};

/// What the selection rule of the 2016 thesis says of one model (theory A19), bug for bug: five values of its
/// first free parameter, three simulations of each against the first segment of every episode, rendered
/// without the camera's noise; a line through each distance over the frames; a line through their slopes over
/// the values; the value at which that is zero is called best. Not to be trusted: a distance that is flat has
/// slope zero however large it is (theory E1).
struct LegacyModel {
  std::string name;
  FreeParameter parameter;
  std::vector<LegacySimulation> simulations;
  LineFit slopes;                                  ///< of the distance's slope against the parameter
  double zero = 0;                                 ///< where it crosses zero
  std::optional<std::array<double, 2>> zero_ci95;  ///< Fieller's; empty when it has no bounds
  double mean = 0, sd = 0;                         ///< of the mean distances of all simulations
  double least_distance_at = 0;                    ///< the value whose simulations are nearest: a better rule
  std::string meaningless;  ///< why its answer means nothing; empty when nothing shows it
};

struct Identification {
  IdentifyStudy study;
  std::vector<ResponseVideo> videos;
  /// Each number that videos and simulations are compared by.
  struct Statistic {
    std::string name;  ///< "segment 1, 2.5 s: median along"
    std::size_t video = 0, episode = 0;
    EpisodeStatistics::Number number;
    double observed = 0;
  };
  std::vector<Statistic> statistics;
  std::vector<std::string> experiments;  ///< that scores are of
  std::vector<FoundModel> models;
  std::size_t best = 0;
  std::string evidence;  ///< "clear", "weak" or "none"
  std::string words;     ///< the same as a sentence
  std::optional<std::array<double, 2>>
      ahead_ci95;  ///< of the best model's lead over the next, per experiment
  double ahead = 0;
  std::vector<LegacyModel> legacy;  ///< what the thesis's rule says of each candidate, when it was asked for
};

}  // namespace faba
