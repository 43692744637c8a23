#include "study/steering/controller_trials.h"

#include <fmt/format.h>

#include <algorithm>
#include <limits>

#include "app/run/notes.h"
#include "app/run/simulation.h"
#include "app/scenario/parts.h"
#include "app/scenario/read_scenario.h"
#include "control/setpoint_count.h"
#include "core/hash.h"
#include "study/steering/metric_list.h"
#include "study/steering/trial.h"

namespace faba {
namespace {

constexpr std::size_t kMostPoints = 600;  // points of the stored time series of a trial

// Controllers that avoid obstacles avoid those that the study measures.
void give_obstacles(const ControllerStudy& study, const Parts& parts, Document& d) {
  if (study.keep_out_px.empty()) return;
  const std::string type = parts.controller.resolve(Node(d).child("controller")).type;
  if (!parts.controller.json_schema(type)["properties"].contains("obstacle")) return;
  Json all = Json::array();
  for (const std::vector<Vec2>& polygon : study.keep_out_px) {
    Json corners = Json::array();
    for (const Vec2 p : polygon) corners.push_back({p.x, p.y});
    all.push_back({{"corners_px", std::move(corners)}});
  }
  d.set("controller.obstacle", std::move(all), "keep_out");
}

/// Results of a trial: the metrics, then times, distances and radii of some of the frames.
std::vector<double> trial_values(const ControllerStudy& study, const Setting& s, std::uint64_t seed,
                                 const std::function<bool()>& stop) {
  const MeasuredTrial t = measured_trial(s.scenario, seed, {s.setpoints, study.keep_out_px}, stop);
  const Series& series = t.series;
  const Metrics& m = t.metrics;
  std::vector<double> values;
  for (const MetricInfo* one : compared_metrics())
    values.push_back((m.*one->value).value_or(std::numeric_limits<double>::quiet_NaN()));
  const std::size_t stride = (series.size() + kMostPoints - 1) / kMostPoints;
  const SwarmColumns swarm = swarm_columns(series);
  for (const std::span<const double> column :
       {series.column("t_s"), series.column("distance_px"), std::span<const double>(swarm.rms_radius)})
    for (std::size_t k = 0; k < series.size(); k += stride) values.push_back(column[k]);
  return values;
}

std::vector<TaskLabel> trial_labels(const ControllerStudy& study, const Setting& s, std::uint64_t seed) {
  return {{"controller", study.controllers[s.controller].name},
          {"model", study.models[s.model].name},
          {"delay_frames", fmt::format("{}", s.delay), double(s.delay)},
          {"seed", fmt::format("{}", seed), double(seed)}};
}

Setting setting(const ControllerStudy& study, std::size_t model, std::size_t controller,
                std::optional<int> delay, const Parts& parts, std::vector<std::string>* notes) {
  Document d = study.scene;
  apply(study.models[model], "model", d);
  apply(study.controllers[controller], "controller", d);
  if (delay) d.set("camera.delay_frames", Json(*delay), "delays");
  give_obstacles(study, parts, d);
  Scenario s = read_scenario(d, parts);
  Pool pool(1);
  const Simulation check(s, study.first_seed, pool);
  if (check.reference().setpoints().empty())
    throw Error(Errc::usage, study.scene.name, "has no setpoint; add a [reference]");
  if (notes)
    for (const std::string& note : scenario_notes(s, check, std::filesystem::current_path()))
      if (std::find(notes->begin(), notes->end(), note) == notes->end()) notes->push_back(note);
  const int frames = s.camera.delay_frames;
  return {controller, model, frames, std::move(s), setpoint_count(check.reference())};
}

}  // namespace

Settings settings_of(const ControllerStudy& study, std::vector<std::string>* notes) {
  std::vector<Setting> all;
  const Parts& parts = study.parts ? *study.parts : builtin_parts();
  std::vector<std::optional<int>> delays(study.delays.begin(), study.delays.end());
  if (delays.empty()) delays.emplace_back();
  for (std::size_t m = 0; m < study.models.size(); ++m)
    for (const std::optional<int> delay : delays)
      for (std::size_t c = 0; c < study.controllers.size(); ++c) try {
          all.push_back(setting(study, m, c, delay, parts, notes));
        } catch (const Error& e) {
          throw Error(e.code(), e.where(),
                      fmt::format("{} (study \"{}\", controller \"{}\")", e.reason(), study.title,
                                  study.controllers[c].name));
        }
  return std::make_shared<const std::vector<Setting>>(std::move(all));
}

Round trials_of(const ControllerStudy& study, const Settings& all, const std::function<bool()>& stop) {
  Round round;
  round.description =
      "controller trials, metrics of version 0.4" + (study.label.empty() ? "" : ": " + study.label);
  const auto seeds = std::uint64_t(study.seeds), first = study.first_seed;
  round.size = all->size() * seeds;
  round.work = [&study, all, seeds, first, stop](std::uint64_t task) {
    return trial_values(study, (*all)[task / seeds], first + task % seeds, stop);
  };
  round.labels = [&study, all, seeds, first](std::uint64_t task) {
    return trial_labels(study, (*all)[task / seeds], first + task % seeds);
  };
  return round;
}

Round controller_trials(const ControllerStudy& study, const std::function<bool()>& stop) {
  return trials_of(study, settings_of(study), stop);
}

std::vector<std::string> trial_value_names() {
  std::vector<std::string> names;
  for (const MetricInfo* m : compared_metrics()) names.push_back(m->key);
  return names;
}

std::string study_hash(const ControllerStudy& study) {
  Hash h;
  h.text("compare-controllers");
  const Settings all = settings_of(study);
  for (const Setting& s : *all) h.text(s.scenario.hash());
  h.value(study.seeds);
  h.value(study.first_seed);
  h.text(study.ranked_by + study.label);
  for (const std::string& name : study.baseline) h.text(name);
  for (const std::vector<Vec2>& polygon : study.keep_out_px)
    for (const Vec2 p : polygon) {
      h.value(p.x);
      h.value(p.y);
    }
  return h.hex();
}

}  // namespace faba
