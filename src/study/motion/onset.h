#pragma once
#include <array>
#include <optional>
#include <span>

namespace faba {

/// Displacements between consecutive frames along the direction of the response and across it.
struct ShiftSeries {
  std::span<const double> t0_s, t1_s, along, across;
};

/// A change of the mean velocity (theory A16). The mean velocity is constant before the change, then rises
/// linearly over a time that may be zero, and then changes linearly.
struct ChangePoint {
  double t_s = 0;                ///< median of the posterior of the time of 10 % of the rise
  std::array<double, 2> ci90{};  ///< shortest interval with 90 % of the posterior, s
  double before = 0, after = 0;  ///< mean displacement per pair before and after the rise
  double t_statistic = 0;        ///< of after - before
  double degrees = 0;            ///< its degrees of freedom
  double rise_s = 0;             ///< duration of the rise
};

/// Fraction of the rise at which the onset is defined.
inline constexpr double kOnsetFraction = 0.1;
/// Probability at which the test of a response finds one without any.
inline constexpr double kFalseResponse = 0.01;

/// The change of velocity at or after `earliest_s`. `latest_s`: end of the search for the maximum velocity.
/// Empty with fewer than three pairs before or eight pairs after `earliest_s`, and when the velocity does not
/// increase.
std::optional<ChangePoint> change_point(const ShiftSeries& series, double earliest_s, double latest_s);

/// Smallest t_statistic of a response: one-sided Student's t for kFalseResponse over the number of
/// independent tests: one each 0.5 s of the search, because that with the largest change is taken, times
/// `others`.
double least_t(const ChangePoint& change, double searched_s, double others);

}  // namespace faba
