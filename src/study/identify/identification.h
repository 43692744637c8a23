#pragma once
#include <array>
#include <optional>
#include <string>
#include <vector>

#include "study/identify/identify_study.h"
#include "study/stats/statistics.h"

namespace faba {

/// Estimate of one parameter.
struct FoundParameter {
  FreeParameter parameter;
  double median = 0;
  std::array<double, 2> ci90{};
  double abc_median = 0;  ///< from approximate Bayesian computation with the same simulations
  std::array<double, 2> abc_ci90{};
  /// 90 % interval of the bootstrap over experiments; empty for fewer than three experiments.
  std::optional<std::array<double, 2>> resampled90 = {};
  /// Fraction of the prior range that the interval covers; 0.9 for a uniform posterior.
  double fraction_of_range = 1;
  std::vector<double> draws = {};
  /// Profile likelihood: log-likelihood at each value, maximised over the other parameters, relative to the
  /// maximum.
  std::vector<double> profile_at = {}, profile = {};
  std::string doubt = {};  ///< why the estimate is not reliable; empty when there is no reason
};

/// Test of an extension of a model (see ModelFamily): whether it explains how the videos deviate from the
/// model.
struct FamilyCheck {
  std::string aspect, what, unit, advice;  ///< as in ModelFamily
  double amount = 0, sd = 0;               ///< estimated amount, in `unit`
  double t = 0, p = 1;                     ///< Student's t of the score test, and its p-value
  double explained = 0;                    ///< fraction of the squared deviations that it removes
  double effect = 0;                       ///< largest change of a statistic by this amount
  bool significant = false;                ///< at the level of all tests of a model together
  bool named = false;                      ///< significant, and not clearly worse than the best family
};

/// Result for one candidate model.
struct FoundModel {
  std::string name;
  std::string failed;  ///< reason of a failed identification; else empty
  std::vector<FoundParameter> parameters;
  double score = 0;  ///< mean of the energy scores
  std::vector<double>
      scores;  ///< energy score of each experiment, predicted from the others; lower is better
  /// Fraction of the simulations of this model that deviate from their mean as much as the observation. Below
  /// 0.01 the model does not explain the videos.
  double fit_p = 0;
  /// Tests of the families of the model, in ascending order of p.
  std::vector<FamilyCheck> families = {};
  const FamilyCheck* missed_family() const {  ///< the most significant one; null for none
    for (const FamilyCheck& c : families)
      if (c.significant) return &c;
    return nullptr;
  }
  /// Index of the significant family of the cells whose extension gives the lowest scores, and these scores;
  /// empty when none is significant.
  std::optional<std::size_t> extension = {};
  std::vector<double> extended_scores = {};
  /// Whether no simulation of the search is much nearer to the videos than the model at its posterior. If
  /// false, the search ended in a wrong region of the parameters.
  bool converged = true;
  static constexpr double kPoorFit = 0.01;
  static constexpr double kDoubtfulFit = 0.05;  ///< below it the evidence for the model is not clear
  std::vector<double> predicted, predicted_sd;  ///< statistics at the posterior median
  /// 90 % posterior predictive interval of each statistic.
  std::vector<std::array<double, 2>> predicted90 = {};
  /// Valid simulations of all rounds, for each video. More than the study requests when the last round was
  /// repeated, fewer when some failed.
  std::size_t simulations = 0;
  std::size_t rounds = 0;  ///< 4 or 5, and up to 2 repetitions of the last round
  Json best;               ///< posterior medians of the parameters, by path
};

/// Comparison of one simulation with one segment of a video by the method of the thesis.
struct LegacySimulation {
  double value = 0;  ///< value of the parameter
  std::size_t video = 0, episode = 0, repeat = 0;
  std::vector<double> distance;  ///< of each pair of frames
  LineFit line;                  ///< distance against frame number
  double mean = 0;
};

/// Selection rule of the 2016 thesis for one model (theory A19), reproduced including its errors: five values
/// of the first free parameter and three simulations of each, compared with the first segment of every
/// episode and rendered without camera noise; a line fit of each distance over the frames; a line fit of
/// these slopes over the values. The rule selects the value at which the second line is zero. It is not
/// reliable: a constant distance has slope zero, however large it is (theory E1).
struct LegacyModel {
  std::string name;
  FreeParameter parameter;
  std::vector<LegacySimulation> simulations;
  LineFit slopes;                                  ///< slope of the distance against the parameter
  double zero = 0;                                 ///< value at which it is zero
  std::optional<std::array<double, 2>> zero_ci95;  ///< Fieller interval; empty when it is unbounded
  double mean = 0, sd = 0;                         ///< of the mean distances of all simulations
  double least_distance_at = 0;                    ///< value with the smallest mean distance: a better rule
  std::string invalid_reason;                      ///< why the result is invalid; else empty
};

struct Identification {
  IdentifyStudy study;
  std::vector<ResponseVideo> videos;
  /// A statistic by which videos and simulations are compared.
  struct Statistic {
    std::string name;  ///< "segment 1, 2.5 s: median along"
    std::size_t video = 0, episode = 0;
    EpisodeStatistics::Number number;
    double observed = 0;
  };
  std::vector<Statistic> statistics;
  std::vector<std::string> experiments;  ///< in the order of FoundModel::scores
  std::string parts = "experiments";     ///< "field segments" when these take the role of experiments
  std::vector<FoundModel> models;
  std::size_t best = 0;
  std::string evidence;   ///< "clear", "weak" or "none"
  std::string words;      ///< the evidence as a sentence
  double score_lead = 0;  ///< mean difference of energy scores per experiment: second-best minus best model
  std::optional<std::array<double, 2>> score_lead_ci95;
  /// Model whose extension by a family removes the clear evidence for the best one, or is better than it;
  /// empty for none.
  std::optional<std::size_t> rival = {};
  std::vector<LegacyModel> legacy;  ///< rule of the thesis for each candidate, when requested
};

}  // namespace faba
