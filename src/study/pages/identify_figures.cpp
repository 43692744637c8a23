#include "study/pages/identify_figures.h"
#include "study/identify/response/response_survey.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>

#include "app/scenario/parts.h"
#include "app/scenario/read_scenario.h"
#include "study/plot/markup.h"
#include "study/quality/rounded.h"

namespace faba {
namespace {

constexpr double kLineBreak = std::numeric_limits<double>::quiet_NaN();
constexpr std::size_t kMaxEpisodes = 4;  // with figures
constexpr int kBins = 24;
constexpr double kProfileLevel =
    -1.353;  // 90 % interval: half of 2.706, the chi-square quantile for one degree of freedom

using Statistic = Identification::Statistic;

std::string label_of(const FreeParameter& p) {
  const std::string unit = p.shown_unit();
  return p.path + (unit.empty() ? "" : " (" + unit + ")");
}

Plot plot_of(const std::string& heading, std::string x, std::string y) {
  Plot p;
  p.description = heading;
  p.inlined = true;
  p.x.label = std::move(x);
  p.y.label = std::move(y);
  return p;
}

/// One statistic of an episode over time, observed and predicted, with gaps between segments.
struct StatisticSeries {
  Line observed;
  Ribbon predicted;
};
StatisticSeries series_of(const Identification& r, std::size_t video, std::size_t episode,
                          const std::string& what, const std::string& label, Ink ink, double (*map)(double)) {
  StatisticSeries c;
  c.observed.label = label;
  c.observed.ink = c.predicted.ink = ink;
  std::size_t segment = 0;
  for (std::size_t k = 0; k < r.statistics.size(); ++k) {
    const Statistic& s = r.statistics[k];
    if (s.video != video || s.episode != episode || s.number.what != what) continue;
    if (s.number.segment != segment) {
      segment = s.number.segment;
      c.observed.x.push_back(s.number.t_s);
      c.observed.y.push_back(kLineBreak);
      c.predicted.x.push_back(s.number.t_s);
      c.predicted.lo.push_back(kLineBreak);
      c.predicted.hi.push_back(kLineBreak);
    }
    const auto& band = r.models[r.best].predicted90[k];
    c.observed.x.push_back(s.number.t_s);
    c.observed.y.push_back(map(s.observed));
    c.predicted.x.push_back(s.number.t_s);
    c.predicted.lo.push_back(map(band[0]));
    c.predicted.hi.push_back(map(band[1]));
  }
  return c;
}

double unchanged(double x) { return x; }
double from_log(double x) { return std::exp(x); }

Figure series_figure(const Identification& r, std::size_t video, std::size_t episode,
                     const std::string& heading, const std::string& caption, const std::string& y,
                     const std::vector<std::tuple<const char*, const char*, Ink>>& what,
                     double (*map)(double)) {
  Figure f{heading, caption, plot_of(heading, "time (s)", y)};
  std::vector<StatisticSeries> all;
  all.reserve(what.size());
  for (const auto& [name, label, ink] : what)
    all.push_back(series_of(r, video, episode, name, label, ink, map));
  for (StatisticSeries& c : all) f.plot.add(std::move(c.predicted));
  for (StatisticSeries& c : all) {
    f.plot.add(Scatter{.x = c.observed.x, .y = c.observed.y, .label = {}, .ink = c.observed.ink});
    f.plot.add(std::move(c.observed));
  }
  return f;
}

Figure by_segment(const Identification& r) {
  Figure f{
      "Velocity along each segment",
      "Median velocity of the tracked cells along the direction of each segment. Dots: video. Bars: 90 % "
      "predictive interval of the best model.",
      plot_of("Velocity along each segment", "segment", "velocity along the segment (um/s)")};
  Line bars{.x = {}, .y = {}, .label = "predicted, 90 %", .ink = Ink::vermillion, .width = 5};
  Scatter dots{.x = {}, .y = {}, .label = "video", .ink = Ink::blue, .size = 8};
  double n = 0;
  for (std::size_t k = 0; k < r.statistics.size(); ++k) {
    const Statistic& s = r.statistics[k];
    if (s.number.what != "median speed along") continue;
    const ResponseVideo& v = r.videos[s.video];
    const double um_s = v.um_per_px * v.fps;  // per pixel per frame
    const auto& band = r.models[r.best].predicted90[k];
    ++n;
    dots.x.push_back(n);
    dots.y.push_back(s.observed * um_s);
    for (const double x : {band[0] * um_s, band[1] * um_s, kLineBreak}) {
      bars.x.push_back(n);
      bars.y.push_back(x);
    }
  }
  f.plot.x.lo = 0.5;
  f.plot.x.hi = n + 0.5;
  f.plot.x.ticks = Ticks::integers;
  f.plot.add(std::move(bars)).add(std::move(dots));
  return f;
}

/// Histogram of the signal of the swarm along a direction, sum 1.
std::vector<double> histogram_along(const GrayF& frame, const CellView& view, double direction_deg) {
  const Foreground foreground = view.foreground_in(frame);
  const Vec2 direction = unit_vector(direction_deg);
  const double half = 0.5 * (std::fabs(direction.x) * view.width + std::fabs(direction.y) * view.height);
  const Vec2 middle{0.5 * view.width, 0.5 * view.height};
  std::vector<double> sum(kBins, 0.0);
  double all = 0;
  const GrayF& w = foreground.weights();
  for (int r = 0; r < w.height; ++r)
    for (int c = 0; c < w.width; ++c) {
      const double position = (dot(Vec2{double(c), double(r)} - middle, direction) / half + 1) / 2;
      const double mass = double(w.at(c, r));
      sum[std::size_t(std::clamp(int(position * kBins), 0, kBins - 1))] += mass;
      all += mass;
    }
  for (double& x : sum) x /= all > 0 ? all : 1;
  return sum;
}

Figure distribution_figure(const EpisodePictures& e, const ResponseVideo& v, double deg) {
  Figure f{"Distribution along the segment",
           "Fraction of the signal of the swarm in each of 24 bins along the direction of the first segment. "
           "Solid: video. Dashed: one simulation of the best model.",
           plot_of("Distribution along the segment", "position along the segment (fraction of the view)",
                   "fraction of the signal")};
  constexpr Ink kInks[] = {Ink::blue, Ink::vermillion, Ink::green};
  std::vector<double> x(kBins);
  for (int i = 0; i < kBins; ++i) x[std::size_t(i)] = (i + 0.5) / kBins;
  for (std::size_t k = 0; k < e.t_s.size(); ++k) {
    f.plot.add(Line{.x = x,
                    .y = histogram_along(e.real[k], v.view, deg),
                    .label = fmt::format("{:.2g} s", e.t_s[k]),
                    .ink = kInks[k % 3]});
    f.plot.add(Line{.x = x,
                    .y = histogram_along(e.simulated[k], v.view, deg),
                    .label = {},
                    .ink = kInks[k % 3],
                    .dashed = true});
  }
  return f;
}

}  // namespace

std::vector<Figure> predictive_figures(const Identification& r) {
  if (r.study.measure == Measure::tracks) return {by_segment(r)};
  std::vector<Figure> figures;
  for (std::size_t v = 0; v < r.videos.size() && figures.size() < 2 * kMaxEpisodes; ++v)
    for (std::size_t e = 0; e < r.videos[v].episodes.size() && figures.size() < 2 * kMaxEpisodes; ++e) {
      const std::string where = r.videos.size() > 1 ? ": " + r.videos[v].episodes[e].name : "";
      figures.push_back(series_figure(
          r, v, e, "Position of the swarm" + where,
          "10, 50 and 90 % quantiles of the position of the cells in view along the direction of "
          "each segment. Dots: video. Shaded: 90 % predictive interval of the best model.",
          "position along the segment (fraction of the view)",
          {{"10 % along", "10 %", Ink::blue},
           {"median along", "50 %", Ink::vermillion},
           {"90 % along", "90 %", Ink::green}},
          unchanged));
      figures.push_back(
          series_figure(r, v, e, "Cells in view" + where,
                        "Signal of the swarm in view, relative to its mean over time. Dots: video. Shaded: "
                        "90 % predictive interval of the best model.",
                        "relative to the mean", {{"cells in view", "cells in view", Ink::blue}}, from_log));
    }
  return figures;
}

Figure posterior_figure(const FoundParameter& p, const std::string& parts) {
  const FreeParameter& q = p.parameter;
  const RoundedInterval text = rounded_interval(q.shown(p.median), {q.shown(p.ci90[0]), q.shown(p.ci90[1])});
  Figure f{q.path,
           fmt::format("{} [{}, {}]{}{}: posterior median and 90 % interval. Dashed: 90 % interval from "
                       "approximate Bayesian computation (ABC){}.{}",
                       text.value, text.low, text.high, q.shown_unit().empty() ? "" : " ", q.shown_unit(),
                       p.resampled90 ? " and from the bootstrap over " + parts : "",
                       p.doubt.empty() ? "" : " " + p.doubt + "."),
           plot_of("Posterior of " + q.path, label_of(q), "density")};
  const auto [lo, hi] = std::minmax_element(p.draws.begin(), p.draws.end());
  const double from = q.shown(*lo), step = (q.shown(*hi) - from) / kBins;
  std::vector<double> count(kBins, 0.0);
  if (step > 0)
    for (const double x : p.draws)
      count[std::size_t(std::clamp(int((q.shown(x) - from) / step), 0, kBins - 1))] +=
          1 / (double(p.draws.size()) * step);
  Line steps{.x = {}, .y = {}, .label = {}, .ink = Ink::blue, .stairs = true};
  for (int i = 0; i <= kBins; ++i) {
    steps.x.push_back(from + i * step);
    steps.y.push_back(i < kBins ? count[std::size_t(i)] : 0);
  }
  f.plot.y.lo = 0;
  f.plot.add(Band{q.shown(p.ci90[0]), q.shown(p.ci90[1]), {}, true});
  f.plot.add(std::move(steps));
  f.plot.add(Rule{.at = q.shown(p.median), .label = {}, .ink = Ink::blue});
  const double top = *std::max_element(count.begin(), count.end());
  const auto across = [&](const std::array<double, 2>& interval, double height, const char* label, Ink ink) {
    f.plot.add(Line{.x = {q.shown(interval[0]), q.shown(interval[1])},
                    .y = {height * top, height * top},
                    .label = label,
                    .ink = ink,
                    .dashed = true,
                    .width = 3});
  };
  across(p.abc_ci90, 0.04, "ABC, 90 %", Ink::vermillion);
  if (p.resampled90) across(*p.resampled90, 0.08, "bootstrap, 90 %", Ink::green);
  return f;
}

Figure profile_figure(const FoundParameter& p) {
  const FreeParameter& q = p.parameter;
  Figure f{
      "Profile of " + q.path,
      "Log-likelihood at each value, maximised over the other parameters. Values above the line form the "
      "90 % confidence interval. A flat profile means that the parameter is not identifiable.",
      plot_of("Profile of " + q.path, label_of(q), "log-likelihood")};
  std::vector<double> x;
  for (const double v : p.profile_at) x.push_back(q.shown(v));
  f.plot.y.lo = -8;
  f.plot.y.hi = 0.5;
  f.plot.add(Rule{.at = kProfileLevel, .label = "90 %", .of_x = false});
  f.plot.add(Line{.x = x, .y = p.profile, .label = {}, .ink = Ink::blue});
  return f;
}

std::vector<Figure> legacy_figures(const LegacyModel& m) {
  const FreeParameter& q = m.parameter;
  Figure distances{
      m.name + ": difference over time",
      "Quadratic-Chi distance between the flow histograms of the video and of the first simulation of each "
      "value, for each pair of frames. Dashed, in the colour of the value: straight line fitted to the "
      "differences by least squares.",
      plot_of("Difference over time", "pair of frames", "difference")};
  Figure slopes{m.name + ": slope against " + q.name(),
                fmt::format("Dots: slope of each simulation. The line fit is zero at {}.",
                            three_digits(q.shown(m.zero))),
                plot_of("Slope against the parameter", label_of(q), "slope per pair")};
  distances.plot.x.ticks = Ticks::integers;
  Scatter dots{.x = {}, .y = {}, .label = {}, .ink = Ink::blue};
  constexpr Ink kInks[] = {Ink::blue, Ink::vermillion, Ink::green, Ink::purple, Ink::orange};
  std::size_t shown = 0;
  for (const LegacySimulation& s : m.simulations) {
    dots.x.push_back(q.shown(s.value));
    dots.y.push_back(s.line.slope);
    if (s.repeat > 0 || s.video > 0 || s.episode > 0) continue;
    const Ink ink = kInks[shown++ % std::size(kInks)];
    Line series{.x = {}, .y = s.distance, .label = three_digits(q.shown(s.value)), .ink = ink, .width = 1.2};
    for (std::size_t i = 0; i < s.distance.size(); ++i) series.x.push_back(double(i));
    const double last = double(s.distance.size() - 1);
    distances.plot.add(std::move(series));
    distances.plot.add(Line{.x = {0, last},
                            .y = {s.line.intercept, s.line.intercept + s.line.slope * last},
                            .label = {},
                            .ink = ink,
                            .dashed = true});
  }
  const auto [low, high] = std::minmax_element(dots.x.begin(), dots.x.end());
  const double per_shown = q.shown(1);
  const auto line_at = [&](double x) { return m.slopes.intercept + m.slopes.slope * x / per_shown; };
  slopes.plot.add(Rule{.at = 0, .label = {}, .of_x = false});
  slopes.plot.add(
      Line{.x = {*low, *high}, .y = {line_at(*low), line_at(*high)}, .label = {}, .ink = Ink::vermillion});
  slopes.plot.add(std::move(dots));
  return {distances, slopes};
}

std::vector<EpisodePictures> episode_pictures(const Identification& r) {
  const Candidate& candidate = r.study.candidates[r.best];
  std::vector<EpisodePictures> all;
  for (const ResponseVideo& v : r.videos)
    for (std::size_t e = 0; e < v.episodes.size() && all.size() < 2; ++e) {
      const Episode& episode = v.episodes[e];
      Document d = episode_scenario(
          v, episode, {r.study.boundary, r.study.scene, candidate.model, candidate.field_strength_in(v)},
          exact_timing(episode));
      for (const auto& [path, value] : r.models[r.best].best.items()) d.set(path, value, "best");
      EpisodePictures& one = all.emplace_back();
      one.name = episode.name;
      one.t_s = picture_times(episode);
      one.real = v.pictures[e];
      one.simulated = simulate_episode(read_scenario(d, builtin_parts()), r.study.seed, {}, one.t_s,
                                       Look::video, v.ground)
                          .frames;
      one.distribution = distribution_figure(one, v, episode.segments.front().direction_deg);
    }
  return all;
}

}  // namespace faba
