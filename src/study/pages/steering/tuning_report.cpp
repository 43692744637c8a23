#include "study/pages/steering/tuning_report.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "core/counted.h"
#include "core/toml.h"
#include "core/units.h"
#include "study/pages/provenance_output.h"
#include "study/plot/figure.h"
#include "study/plot/markup.h"
#include "study/plot/report_page.h"
#include "study/quality/rounded.h"
#include "study/steering/metric_list.h"

namespace faba {
namespace {

Json finite_number(double v) { return std::isfinite(v) ? Json(v) : Json(); }
Json tuned_mean_json(const MeanOverSeeds& m) {
  if (m.n == 0) return {};
  return {{"mean", finite_number(m.mean)},
          {"sd", finite_number(m.sd)},
          {"ci95", {finite_number(m.ci95[0]), finite_number(m.ci95[1])}},
          {"n", m.n}};
}

Json point_json(const Tuning& t, const TunedPoint& p) {
  Json values = Json::object();
  for (std::size_t i = 0; i < p.value.size(); ++i) values[t.study.parameters[i].key] = p.value[i];
  return {{"values", p.value.empty() ? Json() : values},
          {"metric", tuned_mean_json(p.metric)},
          {"refused", p.refused}};
}

const TunedPoint& best_of(const Tuning& t) { return t.evaluated[t.best]; }

// The mean of every parameter set, in the order of the search, and the smallest so far.
Figure search_figure(const Tuning& t) {
  const MetricInfo& info = metric(t.study.metric);
  Figure f{"Search",
           fmt::format("Mean over {} of each parameter set, in the order of the search. Line: the smallest "
                       "so far.",
                       counted(std::uint64_t(t.study.seeds), "training seed")),
           {}};
  f.plot.description = "Metric against the number of the parameter set";
  f.plot.inlined = true;
  f.plot.x.label = "parameter set";
  f.plot.x.ticks = Ticks::integers;
  f.plot.y.label = fmt::format("{} ({})", info.name, info.unit);
  f.plot.y.lo = 0;
  Scatter points{.x = {}, .y = {}, .label = "parameter set", .ink = Ink::blue};
  Line smallest{.x = {}, .y = {}, .label = "smallest so far", .ink = Ink::vermillion};
  double least = INFINITY;
  for (std::size_t i = 0; i < t.evaluated.size(); ++i) {
    const MeanOverSeeds& m = t.evaluated[i].metric;
    if (m.n < t.study.seeds) continue;  // not a candidate
    least = std::min(least, m.mean);
    points.x.push_back(double(i + 1));
    points.y.push_back(m.mean * info.shown);
    smallest.x.push_back(double(i + 1));
    smallest.y.push_back(least * info.shown);
  }
  f.plot.add(std::move(smallest));
  f.plot.add(std::move(points));
  return f;
}

std::string parameters_table(const Tuning& t) {
  std::string out = "<h2>Parameters</h2>\n<table class=\"numbers\"><thead>" +
                    table_row({"parameter", "given", "tuned", "range of the search"}, "th") +
                    "</thead><tbody>\n";
  for (std::size_t i = 0; i < t.study.parameters.size(); ++i) {
    const TunedParameter& p = t.study.parameters[i];
    const std::vector<double>& best = best_of(t).value;
    out += table_row({escape_markup(p.key), p.given ? shown_value(p, *p.given) : "–",
                      best.empty() ? "–" : shown_value(p, best[i]),
                      fmt::format("{} to {}", shown_value(p, p.low), shown_value(p, p.high))},
                     "td");
  }
  return out + "</tbody></table>\n";
}

std::string comparison_table(const Tuning& t) {
  const auto cells = [&](const char* name, const TunedPoint& training, const TunedPoint& held) {
    return table_row({name, tuned_text(t, training.metric), tuned_text(t, held.metric)}, "td");
  };
  return fmt::format("<h2>{}</h2>\n<table class=\"numbers\"><thead>",
                     escape_markup(metric(t.study.metric).name)) +
         table_row({"", fmt::format("training, {}", counted(std::uint64_t(t.study.seeds), "seed")),
                    fmt::format("held out, {}", counted(std::uint64_t(t.study.held_out_seeds), "seed"))},
                   "th") +
         "</thead><tbody>\n" + cells("given", t.evaluated.front(), t.held_out_given) +
         cells("tuned", best_of(t), t.held_out_best) +
         "</tbody></table>\n<p class=\"note\">± is half of the 95 % confidence interval of the mean. The "
         "training seeds "
         "chose the parameters, so that only the held-out seeds show the improvement.</p>\n";
}

}  // namespace

std::string tuned_text(const Tuning& t, const MeanOverSeeds& m, const char* plus_minus) {
  const MetricInfo& info = metric(t.study.metric);
  if (m.n == 0) return "undefined";
  return fmt::format("{} {}",
                     with_uncertainty(m.mean * info.shown, (m.mean - m.ci95[0]) * info.shown, plus_minus),
                     info.unit);
}

std::string shown_value(const TunedParameter& p, double value) {
  return p.unit == "px" ? fmt::format("{:.4g} px", value)
                        : fmt::format("{:.4g}{}{}", value, p.unit.empty() ? "" : " ", p.unit);
}

std::vector<std::string> tuning_notes(const Tuning& t) {
  std::vector<std::string> notes = t.study.notes;
  const std::vector<double>& best = best_of(t).value;
  for (std::size_t i = 0; i < best.size(); ++i) {
    const TunedParameter& p = t.study.parameters[i];
    // Within 1 % of the logarithm of the range, the tolerance of the search.
    const double u = std::log(best[i] / p.low) / std::log(p.high / p.low);
    if (u < 0.01 || u > 0.99)
      notes.push_back(
          fmt::format("{} = {} is at the end of its range, so that a better value may lie outside; "
                      "extend the range with --range {}=LOW..HIGH",
                      p.key, shown_value(p, best[i]), p.key));
  }
  const auto refused =
      std::count_if(t.evaluated.begin(), t.evaluated.end(), [](const TunedPoint& p) { return p.refused; });
  if (refused > 0)
    notes.push_back(fmt::format(
        "the controller refuses {} of the {} parameter sets; `faba run` with such values states the reason",
        refused, t.evaluated.size()));
  const MeanOverSeeds& d = t.held_out_difference;
  if (t.best == 0)
    notes.push_back("no parameter set was better than the given one on the training seeds");
  else if (!(d.n > 1) || !(d.ci95[1] < 0))
    notes.push_back(
        "the tuned parameters are not significantly better than the given ones on the held-out seeds");
  if (best_of(t).metric.n < t.study.seeds)
    notes.push_back(
        fmt::format("the metric is undefined in {} of {} trials; try a longer duration or another --metric",
                    t.study.seeds - best_of(t).metric.n, t.study.seeds));
  return notes;
}

nlohmann::ordered_json tuning_json(const Tuning& t) {
  Json j{{"controller", t.study.controller},
         {"metric", t.study.metric},
         {"parameters", Json::array()},
         {"seeds", t.study.seeds},
         {"first_seed", t.study.first_seed},
         {"evaluated", Json::array()},
         {"best", t.best},
         {"held_out",
          {{"seeds", t.study.held_out_seeds},
           {"first_seed", t.study.first_held_out},
           {"given", tuned_mean_json(t.held_out_given.metric)},
           {"tuned", tuned_mean_json(t.held_out_best.metric)},
           {"difference", tuned_mean_json(t.held_out_difference)}}},
         {"notes", tuning_notes(t)}};
  const std::vector<double>& best = best_of(t).value;
  for (std::size_t i = 0; i < t.study.parameters.size(); ++i) {
    const TunedParameter& p = t.study.parameters[i];
    j["parameters"].push_back({{"key", p.key},
                               {"unit", p.unit},
                               {"range", {p.low, p.high}},
                               {"given", p.given ? Json(*p.given) : Json()},
                               {"tuned", best.empty() ? Json() : Json(best[i])}});
  }
  for (const TunedPoint& p : t.evaluated) j["evaluated"].push_back(point_json(t, p));
  return j;
}

std::string tuning_page(const Tuning& t, const Provenance& provenance) {
  const MeanOverSeeds& d = t.held_out_difference;
  const std::string title = fmt::format("Tuning of {}", t.study.controller);
  std::string out = fmt::format("<h1>{}</h1>\n", escape_markup(title));
  if (t.held_out_best.metric.n > 0)
    out += fmt::format("<p class=\"lead\">{} {} on the held-out seeds; {} with the given parameters{}.</p>\n",
                       escape_markup(metric(t.study.metric).name), tuned_text(t, t.held_out_best.metric),
                       tuned_text(t, t.held_out_given.metric),
                       d.n > 1 && d.ci95[1] < 0 ? "" : " (no significant difference)");
  out += parameters_table(t) + comparison_table(t) + "<h2>Figures</h2>\n<div class=\"figures\">\n";
  int figure_number = 0;
  out += figures_markup({search_figure(t)}, figure_number) + "</div>\n";
  for (const std::string& note : tuning_notes(t))
    out += fmt::format("<p class=\"warning\">{}</p>\n", escape_markup(note));
  return html_page(title, out + provenance_markup(provenance));
}

}  // namespace faba
