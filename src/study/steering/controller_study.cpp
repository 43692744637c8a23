#include "study/steering/controller_study.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <set>

#include "app/run/notes.h"
#include "app/run/simulation.h"
#include "app/scenario/file_kind.h"
#include "app/scenario/parts.h"
#include "app/scenario/read_scenario.h"
#include "control/setpoint_count.h"
#include "core/hash.h"
#include "core/random/distributions.h"
#include "study/stats/statistics.h"
#include "study/steering/metric_list.h"
#include "study/steering/trial.h"

namespace faba {
namespace {

constexpr std::size_t kMostPoints = 600;  // points of the stored time series of a trial

/// The metrics that are compared.
std::vector<const MetricInfo*> compared_metrics() {
  std::vector<const MetricInfo*> all;
  for (const MetricInfo& m : metric_list())
    if (m.compared) all.push_back(&m);
  return all;
}
constexpr const char* kRankedBy = "steady_rms_px";

struct StudyFile {
  std::string title, scene;
  int seeds = 20;
  std::uint64_t first_seed = 1;
  std::vector<int> delays;
  static Schema<StudyFile> schema() {
    return Schema<StudyFile>("compare-controllers", "Comparison of controllers with models and delays")
        .add("title", &StudyFile::title, {.doc = "Title of the study in reports"})
        .add("scene", &StudyFile::scene,
             {.doc = "Scenario of all trials, relative to the folder of the study file"})
        .add("seeds", &StudyFile::seeds,
             {.min = 2, .max = 100000, .doc = "Number of trials of each combination, one seed each"})
        .add("first_seed", &StudyFile::first_seed, {.min = 0, .max = 9e15, .doc = "Seed of the first trial"})
        .add("delays", &StudyFile::delays,
             {.min = 0, .max = 1000, .doc = "Camera delays in frames; default: that of the scene"});
  }
};

/// A combination of controller, model and delay, with its scenario.
struct Setting {
  std::size_t controller = 0, model = 0;
  int delay = 0;
  Scenario scenario;
  std::size_t setpoints = 0;  ///< of the reference
};

std::vector<Setting> settings(const ControllerStudy& study, std::vector<std::string>* notes = nullptr) {
  std::vector<Setting> all;
  const Parts& parts = study.parts ? *study.parts : builtin_parts();
  std::vector<std::optional<int>> delays(study.delays.begin(), study.delays.end());
  if (delays.empty()) delays.emplace_back();
  Pool pool(1);
  for (std::size_t m = 0; m < study.models.size(); ++m)
    for (const std::optional<int> delay : delays)
      for (std::size_t c = 0; c < study.controllers.size(); ++c) {
        Document d = study.scene;
        apply(study.models[m], "model", d);
        apply(study.controllers[c], "controller", d);
        if (delay) d.set("camera.delay_frames", Json(*delay), "delays");
        Scenario s = read_scenario(d, parts);
        const Simulation check(s, study.first_seed, pool);
        if (check.reference().setpoints().empty())
          throw Error(Errc::usage, study.scene.name,
                      fmt::format("has no setpoint for controller \"{}\"; add a [reference]",
                                  study.controllers[c].name));
        if (notes)
          for (const std::string& note : scenario_notes(s, check, std::filesystem::current_path()))
            if (std::find(notes->begin(), notes->end(), note) == notes->end()) notes->push_back(note);
        const int frames = s.camera.delay_frames;
        all.push_back({c, m, frames, std::move(s), setpoint_count(check.reference())});
      }
  return all;
}

/// Results of a trial: the metrics, then times, distances and radii of some of the frames.
std::vector<double> trial_values(const Setting& s, std::uint64_t seed, const std::function<bool()>& stop) {
  const Series series = trial(s.scenario, seed, stop);
  const Metrics m = control_metrics(series, {}, s.setpoints);
  std::vector<double> values;
  for (const MetricInfo* one : compared_metrics()) values.push_back((m.*one->value).value_or(kNaN));
  const std::size_t stride = (series.size() + kMostPoints - 1) / kMostPoints;
  const SwarmColumns swarm = swarm_columns(series);
  for (const std::span<const double> column :
       {series.column("t_s"), series.column("distance_px"), std::span<const double>(swarm.rms_radius)})
    for (std::size_t k = 0; k < series.size(); k += stride) values.push_back(column[k]);
  return values;
}

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

// Compares the controllers with one model and one delay.
void compare_with_best(std::vector<Combination>& all, const std::vector<Trials>& trials, std::size_t begin,
                       std::size_t end) {
  const auto steady = [&](std::size_t i) {
    const auto it = all[i].metrics.find(kRankedBy);
    return it == all[i].metrics.end() ? std::numeric_limits<double>::infinity() : it->second.mean;
  };
  std::size_t best = begin;
  for (std::size_t i = begin; i < end; ++i)
    if (steady(i) < steady(best)) best = i;
  const std::vector<const MetricInfo*> metrics = compared_metrics();
  const auto ranked =
      std::size_t(std::find(metrics.begin(), metrics.end(), &metric(kRankedBy)) - metrics.begin());
  for (std::size_t i = begin; i < end; ++i) {
    if (i == best) continue;
    std::vector<double> difference;
    for (std::size_t k = 0; k < trials[i].size(); ++k)
      difference.push_back(trials[i][k][ranked] - trials[best][k][ranked]);
    const MeanOverSeeds m = mean_over_seeds(difference);
    if (m.n > 1) all[i].excess_over_best = m;
  }
}

}  // namespace

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

ControllerStudy read_controller_study(const std::filesystem::path& file) {
  const Document d = read_toml(file);
  const Node root(d);
  require_kind(root, FileKind::controller_study);
  const StudyFile f = StudyFile::schema().parse(root, {"controller", "model"});
  if (f.scene.empty())
    root.fail("key \"scene\" is missing; specify the scenario of all trials: scene = \"scene.toml\"");
  std::error_code ec;
  if (!std::filesystem::exists(root.file(f.scene), ec))
    throw Error(Errc::usage, root.where("scene"),
                fmt::format("file not found: {} (relative to the study file)", f.scene));
  ControllerStudy study;
  study.title = f.title.empty() ? file.stem().string() : f.title;
  study.scene = read_toml(root.file(f.scene));
  study.controllers = read_variants(root, "controller");
  study.models = read_variants(root, "model");
  if (root.has("delays") && f.delays.empty())
    root.child("delays").fail(
        "is an empty list; list camera delays in frames, such as [0, 2, 5], or omit the key for that of the "
        "scene");
  if (std::set<int>(f.delays.begin(), f.delays.end()).size() != f.delays.size())
    root.child("delays").fail("a delay is listed twice; delays must be unique");
  study.delays = f.delays;
  study.seeds = f.seeds;
  study.first_seed = f.first_seed;
  return study;
}

Json controller_study_schema() {
  Json j = StudyFile::schema().json_schema();
  j["properties"]["controller"] = {{"type", "array"},
                                   {"description", "The controllers, one [[controller]] each"},
                                   {"items", variant_schema("A controller")}};
  j["properties"]["model"] = {{"type", "array"},
                              {"description", "The models of the cells, one [[model]] each"},
                              {"items", variant_schema("A model of the cells")}};
  return j;
}

std::string study_hash(const ControllerStudy& study) {
  Hash h;
  h.text("compare-controllers");
  for (const Setting& s : settings(study)) h.text(s.scenario.hash());
  h.value(study.seeds);
  h.value(study.first_seed);
  return h.hex();
}

namespace {

std::vector<TaskLabel> trial_labels(const ControllerStudy& study, const Setting& s, std::uint64_t seed) {
  return {{"controller", study.controllers[s.controller].name},
          {"model", study.models[s.model].name},
          {"delay_frames", fmt::format("{}", s.delay), double(s.delay)},
          {"seed", fmt::format("{}", seed), double(seed)}};
}

// The round of all trials: for each setting, one trial for each seed.
Round trials_of(const ControllerStudy& study, const std::shared_ptr<const std::vector<Setting>>& all,
                const std::function<bool()>& stop) {
  Round round;
  round.description = "controller trials, metrics of version 0.3";
  const auto seeds = std::uint64_t(study.seeds), first = study.first_seed;
  round.size = all->size() * seeds;
  round.work = [all, seeds, first, stop](std::uint64_t task) {
    return trial_values((*all)[task / seeds], first + task % seeds, stop);
  };
  round.labels = [&study, all, seeds, first](std::uint64_t task) {
    return trial_labels(study, (*all)[task / seeds], first + task % seeds);
  };
  return round;
}

}  // namespace

Json best_scene(const ControllerComparison& r) {
  for (std::size_t c = 0; c < r.study.controllers.size(); ++c) {
    const Combination& one = r.combinations[c];  // those of the first model and delay come first
    if (one.excess_over_best || !one.metrics.contains(kRankedBy)) continue;
    Json scene = settings(r.study)[c].scenario.resolved();
    scene["title"] = fmt::format("{}: {}", r.study.title, one.controller);
    return scene;
  }
  return {};
}

Round controller_trials(const ControllerStudy& study, const std::function<bool()>& stop) {
  return trials_of(study, std::make_shared<const std::vector<Setting>>(settings(study)), stop);
}

std::vector<std::string> trial_value_names() {
  std::vector<std::string> names;
  for (const MetricInfo* m : compared_metrics()) names.push_back(m->key);
  return names;
}

std::optional<ControllerComparison> compare_controllers(const ControllerStudy& study, ResultStore& results,
                                                        const SweepOptions& options) {
  std::vector<std::string> notes;
  const auto shared = std::make_shared<const std::vector<Setting>>(settings(study, &notes));
  const std::vector<Setting>& all = *shared;
  const Round round = trials_of(study, shared, options.stop);
  if (!sweep(results, round, options)) return {};
  const std::uint64_t key = results.key(round);
  ControllerComparison c{study, {}, std::move(notes)};
  std::vector<Trials> trials;
  const auto seeds = std::size_t(study.seeds);
  for (std::size_t i = 0; i < all.size(); ++i) {
    Trials& of = trials.emplace_back();
    for (std::size_t k = 0; k < seeds; ++k) of.push_back(results.find({key, i * seeds + k}).value());
    c.combinations.push_back(combined(study, all[i], of));
  }
  for (std::size_t i = 0; i < all.size(); i += study.controllers.size())
    compare_with_best(c.combinations, trials, i, i + study.controllers.size());
  return c;
}

}  // namespace faba
