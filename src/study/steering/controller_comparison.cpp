// Statistics of the trials of a controller study.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>

#include "core/random/distributions.h"
#include "study/stats/statistics.h"
#include "study/steering/controller_study.h"
#include "study/steering/controller_trials.h"
#include "study/steering/metric_list.h"

namespace faba {

MeanOverSeeds mean_over_seeds(const std::vector<double>& values) {
  MeanOverSeeds m;
  std::vector<double> defined;
  std::copy_if(values.begin(), values.end(), std::back_inserter(defined),
               [](double v) { return std::isfinite(v); });
  m.n = int(defined.size());
  if (m.n == 0) return m;
  for (const double v : defined) m.mean += v / m.n;
  m.sd = sample_sd(defined);
  const double half = m.n > 1 ? student_t_quantile(0.975, m.n - 1) * m.sd / std::sqrt(m.n) : kNaN;
  m.ci95 = {m.mean - half, m.mean + half};
  return m;
}

namespace {

// Wilson's confidence interval of a fraction.
std::array<double, 2> fraction_ci95(int k, int n) {
  constexpr double z = 1.959964;
  const double p = double(k) / n, centre = p + z * z / (2 * n);
  const double half = z * std::sqrt(p * (1 - p) / n + z * z / (4.0 * n * n)), scale = 1 + z * z / n;
  return {std::max(0.0, (centre - half) / scale), std::min(1.0, (centre + half) / scale)};
}

using Trials = std::vector<std::span<const double>>;  // values of each trial, see trial_values()

// Mean and standard deviation over the trials, point by point.
void curves(const Trials& trials, Combination& c) {
  const std::size_t first = compared_metrics().size(), points = (trials.front().size() - first) / 3;
  const auto value = [&](std::span<const double> t, std::size_t what, std::size_t k) {
    return t[first + what * points + k];
  };
  for (std::size_t k = 0; k < points; ++k) {
    c.t_s.push_back(value(trials.front(), 0, k));
    for (const std::size_t what : {std::size_t(1), std::size_t(2)}) {
      std::vector<double> one;
      one.reserve(trials.size());
      for (const auto t : trials) one.push_back(value(t, what, k));
      const MeanOverSeeds m = mean_over_seeds(one);
      (what == 1 ? c.distance_px : c.rms_radius_px).push_back(m.n > 0 ? m.mean : kNaN);
      (what == 1 ? c.distance_sd_px : c.rms_radius_sd_px).push_back(m.n > 0 ? m.sd : kNaN);
    }
  }
}

Combination combined(const ControllerStudy& study, const Setting& s, const Trials& trials) {
  Combination c;
  c.controller = study.controllers[s.controller].name;
  c.model = study.models[s.model].name;
  c.delay = s.delay;
  c.trials = int(trials.size());
  const std::vector<const MetricInfo*> metrics = compared_metrics();
  for (std::size_t i = 0; i < metrics.size(); ++i) {
    std::vector<double> values;
    for (const auto t : trials) values.push_back(t[i]);
    const MeanOverSeeds m = mean_over_seeds(values);
    if (metrics[i]->value == &Metrics::settling_time_s) c.settled = m.n;
    if (m.n > 0) c.metrics[metrics[i]->key] = m;
  }
  c.settled_ci95 = fraction_ci95(c.settled, c.trials);
  curves(trials, c);
  return c;
}

/// The controllers with one model and one delay: [begin, end) of all combinations.
class ControllerGroup {
 public:
  ControllerGroup(const ControllerStudy& study, std::vector<Combination>& all,
                  const std::vector<Trials>& trials, std::size_t begin)
      : study_(study), all_(all), trials_(trials), begin_(begin), end_(begin + study.controllers.size()) {}

  void compare() {
    const std::size_t best = best_of([](const std::string&) { return true; });
    for (std::size_t i = begin_; i < end_; ++i)
      if (const MeanOverSeeds m = difference(i, best, study_.ranked_by); i != best && m.n > 1)
        all_[i].excess_over_best = m;
    if (study_.baseline.empty()) return;
    const auto in_baseline = [&](const std::string& name) {
      return std::find(study_.baseline.begin(), study_.baseline.end(), name) != study_.baseline.end();
    };
    const std::size_t base = best_of(in_baseline);
    for (std::size_t i = begin_; i < end_; ++i) {
      if (in_baseline(all_[i].controller) || !in_baseline(all_[base].controller)) continue;
      all_[i].baseline = all_[base].controller;
      for (const MetricInfo* m : compared_metrics())
        if (const MeanOverSeeds d = difference(i, base, m->key); d.n > 1) all_[i].minus_baseline[m->key] = d;
    }
  }

 private:
  double ranked(std::size_t i) const {
    const auto it = all_[i].metrics.find(study_.ranked_by);
    return it == all_[i].metrics.end() ? std::numeric_limits<double>::infinity() : it->second.mean;
  }
  template <class Permitted>
  std::size_t best_of(const Permitted& permitted) const {
    std::size_t best = end_;
    for (std::size_t i = begin_; i < end_; ++i)
      if (permitted(all_[i].controller) && (best == end_ || ranked(i) < ranked(best))) best = i;
    return best == end_ ? begin_ : best;
  }
  /// Mean over the seeds of the metric of trial i minus that of trial j.
  MeanOverSeeds difference(std::size_t i, std::size_t j, const std::string& key) const {
    const std::vector<const MetricInfo*> metrics = compared_metrics();
    const auto at = std::find(metrics.begin(), metrics.end(), &metric(key)) - metrics.begin();
    std::vector<double> values;
    for (std::size_t k = 0; k < trials_[i].size(); ++k)
      values.push_back(trials_[i][k][std::size_t(at)] - trials_[j][k][std::size_t(at)]);
    return mean_over_seeds(values);
  }

  const ControllerStudy& study_;
  std::vector<Combination>& all_;
  const std::vector<Trials>& trials_;
  std::size_t begin_, end_;
};

}  // namespace

Json best_scene(const ControllerComparison& r) {
  for (std::size_t c = 0; c < r.study.controllers.size(); ++c) {
    const Combination& one = r.combinations[c];  // those of the first model and delay come first
    if (one.excess_over_best || !one.metrics.contains(r.study.ranked_by)) continue;
    Json scene = (*settings_of(r.study))[c].scenario.resolved();
    scene["title"] = fmt::format("{}: {}", r.study.title, one.controller);
    return scene;
  }
  return {};
}

std::optional<ControllerComparison> compare_controllers(const ControllerStudy& study, ResultStore& results,
                                                        const SweepOptions& options) {
  std::vector<std::string> notes;
  const Settings shared = settings_of(study, &notes);
  const std::vector<Setting>& all = *shared;
  const Round round = trials_of(study, shared, options.stop);
  if (!sweep(results, round, options)) return {};
  const std::uint64_t key = results.key(round);
  ControllerComparison c{study, {}, std::move(notes), 1e6 * all.front().scenario.si_scale().m_per_px};
  std::vector<Trials> trials;
  const auto seeds = std::size_t(study.seeds);
  for (std::size_t i = 0; i < all.size(); ++i) {
    Trials& of = trials.emplace_back();
    for (std::size_t k = 0; k < seeds; ++k) of.push_back(results.find({key, i * seeds + k}).value());
    c.combinations.push_back(combined(study, all[i], of));
  }
  for (std::size_t i = 0; i < all.size(); i += study.controllers.size())
    ControllerGroup(study, c.combinations, trials, i).compare();
  return c;
}

}  // namespace faba
