#include "study/identify/legacy_selection.h"
#include "study/identify/response/response_survey.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <map>

#include "app/scenario/parts.h"
#include "app/scenario/read_scenario.h"
#include "core/hash.h"
#include "core/random/distributions.h"
#include "study/data/flow_choice.h"
#include "study/motion/flow_histograms.h"
#include "study/motion/signature.h"
#include "vision/image/kernels/histogram_distance.h"

namespace faba {
namespace {

constexpr int kValues = 5, kRepeats = 3;    // as in the thesis
constexpr double kM = 0.9, kThreshold = 3;  // parameters of the distance (A17)

std::vector<FlowHistograms> histograms_of(const std::vector<GrayF>& frames, const FlowFilter& filter) {
  Pool pool(1);
  const auto method = flow_part({}, published_flow()).make({&pool});
  std::vector<FlowHistograms> pairs(frames.size() - 1);
  Flow flow;
  for (std::size_t i = 0; i + 1 < frames.size(); ++i) {
    method->between(frames[i], frames[i + 1], flow);
    flow_histograms(flow, filter, 1, pairs[i]);
  }
  return pairs;
}

LegacyReference reference_of(const ResponseVideo& v, const Episode& e, const std::function<void()>& reading) {
  LegacyReference r;
  const FieldSegment& segment = e.segments.front();
  const auto last = std::lround(segment.t1_s / v.view.frame_s);
  for (long k = 0; k <= last; ++k) r.times_s.push_back(double(k) * v.view.frame_s);
  std::vector<double> at;
  for (const double t : r.times_s) at.push_back(e.start_s + t);
  FlowSourceOptions options;
  options.threads = 1;
  options.method = flow_part({}, published_flow());
  options.shrink = v.side;
  options.fps = v.input.part.fps;
  r.filter.threshold_px = noise_level(v.file, options, [&](auto, auto) { reading(); }).threshold_px / v.side;
  r.filter.direction_deg = segment.direction_deg;
  r.pairs = histograms_of(frames_at(v, at, reading), r.filter);
  return r;
}

std::vector<double> distances(const LegacyReference& r, const std::vector<GrayF>& frames) {
  HistogramDistance distance(BinSimilarity::truncated_linear(kThreshold), kM);
  const std::vector<FlowHistograms> simulated = histograms_of(frames, r.filter);
  std::vector<double> out;
  for (std::size_t i = 0; i < simulated.size(); ++i)
    out.push_back(distance(r.pairs[i].x, simulated[i].x) + distance(r.pairs[i].y, simulated[i].y));
  return out;
}

void conclude(LegacyModel& m) {
  std::vector<double> value, slope, level_of;
  std::map<double, std::vector<double>> level;
  for (LegacySimulation& s : m.simulations) {
    std::vector<double> frame(s.distance.size());
    for (std::size_t i = 0; i < frame.size(); ++i) frame[i] = double(i);
    s.line = fit_line(frame, s.distance);
    s.mean = mean(s.distance);
    value.push_back(s.value);
    slope.push_back(s.line.slope);
    level_of.push_back(s.mean);
    level[s.value].push_back(s.mean);
  }
  m.slopes = fit_line(value, slope);
  m.zero = -m.slopes.intercept / m.slopes.slope;
  m.zero_ci95 = zero_crossing_ci95(m.slopes, mean(value));
  m.mean = mean(level_of);
  m.sd = sample_sd(level_of);
  m.least_distance_at = std::min_element(level.begin(), level.end(), [](const auto& a, const auto& b) {
                          return mean(a.second) < mean(b.second);
                        })->first;
  const auto [low, high] = std::minmax_element(value.begin(), value.end());
  const FreeParameter& p = m.parameter;
  if (!m.zero_ci95)
    m.invalid_reason = fmt::format(
        "the slope does not depend significantly on {}, so the position of its zero is undetermined", p.path);
  else if (m.zero < *low || m.zero > *high)
    m.invalid_reason = fmt::format(
        "the slope is zero at {:.4g}, outside the tested values {:.4g} to {:.4g}{}", p.shown(m.zero),
        p.shown(*low), p.shown(*high), p.shown_unit().empty() ? "" : " " + p.shown_unit());
}

}  // namespace

std::optional<std::array<double, 2>> zero_crossing_ci95(const LineFit& line, double mean_x) {
  const double t = student_t_quantile(0.975, line.freedom), tt = t * t;
  const double va = line.se_slope * line.se_slope, vb = line.se_intercept * line.se_intercept,
               vab = -mean_x * va;
  const double a = line.slope * line.slope - tt * va, b = line.slope * line.intercept - tt * vab,
               c = line.intercept * line.intercept - tt * vb;
  if (!(a > 0)) return {};
  const double root = std::sqrt(std::max(0.0, b * b - a * c));
  return std::array{(-b - root) / a, (-b + root) / a};
}

namespace {

// Tested values of the first free parameter, as fractions of its range.
std::vector<double> tested_fractions(const Candidate& c) {
  std::vector<double> fractions;
  for (const double v : c.legacy_values) fractions.push_back(c.free.front().fraction(v));
  for (int i = 0; c.legacy_values.empty() && i < kValues; ++i) fractions.push_back((i + 0.5) / kValues);
  return fractions;
}

// The simulations in the order of the tasks.
std::vector<LegacyModel> planned_models(const IdentifyStudy& study,
                                        const std::vector<ResponseVideo>& videos) {
  std::vector<LegacyModel> models;
  for (const Candidate& c : study.candidates) {
    LegacyModel m;
    m.name = c.model.name;
    m.parameter = c.free.front();
    for (const double u : tested_fractions(c))
      for (std::size_t v = 0; v < videos.size(); ++v)
        for (std::size_t e = 0; e < videos[v].episodes.size(); ++e)
          for (std::size_t k = 0; k < std::size_t(kRepeats); ++k)
            m.simulations.push_back({c.free.front().value(u), v, e, k, {}, {}, 0});
    models.push_back(std::move(m));
  }
  return models;
}

/// A simulation and the indices that its seed depends on.
struct LegacyTask {
  std::size_t candidate = 0, value = 0;
  LegacySimulation simulation;
};

std::vector<double> simulate_legacy(const IdentifyStudy& study, const std::vector<ResponseVideo>& videos,
                                    const LegacyReferences& references, const LegacyTask& t) {
  const Candidate& c = study.candidates[t.candidate];
  const auto [v, e] = std::pair(t.simulation.video, t.simulation.episode);
  const ResponseVideo& video = videos[v];
  Episode episode = video.episodes[e];
  episode.segments.resize(1);
  Document d =
      episode_scenario(video, episode, {study.boundary, study.scene, c.model, c.field_strength_in(video)},
                       exact_timing(episode));
  d.set(c.free.front().path, c.free.front().json(tested_fractions(c)[t.value]), "legacy");
  d.root["microscope"]["noise"] = 0;
  Hash h;
  h.value(study.seed);
  h.text(c.model.name);
  h.value(int(t.value));
  h.value(v);
  h.value(e);
  h.value(int(t.simulation.repeat));
  const LegacyReference& r = references[v][e];
  return distances(r, simulate_episode(read_scenario(d, builtin_parts()), h.result() >> 1, {}, r.times_s,
                                       Look::video, video.ground)
                          .frames);
}

}  // namespace

LegacyReferences legacy_references(const std::vector<ResponseVideo>& videos,
                                   const std::function<void()>& reading) {
  LegacyReferences references;
  for (const ResponseVideo& v : videos) {
    auto& of_video = references.emplace_back();
    for (const Episode& e : v.episodes) of_video.push_back(reference_of(v, e, reading));
  }
  return references;
}

Round legacy_round(const IdentifyStudy& study, const std::vector<ResponseVideo>& videos,
                   const LegacyReferences& references) {
  std::vector<LegacyTask> tasks;
  const std::vector<LegacyModel> models = planned_models(study, videos);
  for (std::size_t c = 0; c < models.size(); ++c) {
    const std::size_t values = tested_fractions(study.candidates[c]).size(),
                      of_value = models[c].simulations.size() / values;
    for (std::size_t i = 0; i < models[c].simulations.size(); ++i)
      tasks.push_back({c, i / of_value, models[c].simulations[i]});
  }
  Round round;
  round.description = kLegacyRound;
  round.size = tasks.size();
  round.work = [&study, &videos, &references, tasks](std::uint64_t task) {
    return simulate_legacy(study, videos, references, tasks[task]);
  };
  round.labels = [&study, &videos, tasks](std::uint64_t task) -> std::vector<TaskLabel> {
    const LegacyTask& t = tasks[task];
    const LegacySimulation& l = t.simulation;
    return {{"model", study.candidates[t.candidate].model.name},
            {study.candidates[t.candidate].free.front().path, fmt::format("{:.6g}", l.value), l.value},
            {"episode", videos[l.video].episodes[l.episode].name},
            {"repeat", fmt::format("{}", l.repeat + 1), double(l.repeat + 1)}};
  };
  return round;
}

std::optional<std::vector<LegacyModel>> legacy_selection(const IdentifyStudy& study,
                                                         const std::vector<ResponseVideo>& videos,
                                                         const LegacyReferences& references,
                                                         ResultStore& results, const SweepOptions& options) {
  const Round round = legacy_round(study, videos, references);
  if (!sweep(results, round, options)) return {};
  const std::uint64_t key = results.key(round);
  std::vector<LegacyModel> models = planned_models(study, videos);
  std::uint64_t at = 0;
  for (LegacyModel& m : models) {
    for (LegacySimulation& one : m.simulations) {
      const std::span<const double> values = results.find({key, at++}).value();
      one.distance.assign(values.begin(), values.end());
    }
    conclude(m);
  }
  return models;
}

}  // namespace faba
