#include "study/pages/steering/controller_report.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "core/counted.h"
#include "core/toml.h"
#include "study/pages/provenance_output.h"
#include "study/plot/markup.h"
#include "study/plot/report_page.h"
#include "study/quality/rounded.h"

namespace faba {
namespace {

const MeanOverSeeds* metric_of(const Combination& c, const char* name) {
  const auto it = c.metrics.find(name);
  return it == c.metrics.end() ? nullptr : &it->second;
}

Json mean_json(const MeanOverSeeds& m) {
  return {{"mean", m.mean}, {"sd", m.sd}, {"ci95", m.ci95}, {"n", m.n}};
}

// Markup: "2.13" with "1.9 to 2.4" below it.
std::string with_interval(const MeanOverSeeds* m) {
  if (!m) return "–";
  if (m->n < 2) return three_digits(m->mean);
  const RoundedInterval text = rounded_interval(m->mean, m->ci95);
  return fmt::format("{}<small>{} to {}</small>", text.value, text.low, text.high);
}

constexpr std::pair<const char*, const char*> kColumns[] = {
    {"settling_time_s", "settling time (s)"},
    {"steady_rms_px", "steady-state error (px rms)"},
    {"iae_px_s", "IAE (px s)"},
    {"cross_track_95_px", "cross-track error (px, 95 %)"},
    {"rms_radius_px", "final dispersion (px rms)"},
    {"control_effort_a2_s", "control effort (A² s)"},
    {"total_variation_ut", "total variation (µT)"}};

bool several_delays(const ControllerComparison& r) { return r.study.delays.size() > 1; }

std::string condition(const ControllerComparison& r, const Combination& c) {
  std::string text = r.study.models.size() > 1 ? c.model : "";
  if (several_delays(r))
    text += fmt::format("{}delay {}", text.empty() ? "" : ", ", counted(std::uint64_t(c.delay), "frame"));
  return text;
}

std::string table(const ControllerComparison& r) {
  std::vector<std::pair<const char*, const char*>> columns;
  for (const auto& column : kColumns)
    if (std::any_of(r.combinations.begin(), r.combinations.end(), [&](const Combination& c) {
          return metric_of(c, column.first) && metric_of(c, column.first)->mean != 0;
        }))
      columns.push_back(column);
  std::vector<std::string> head{"controller", "settled"};
  if (!condition(r, r.combinations.front()).empty()) head.insert(head.begin() + 1, "condition");
  head.emplace_back("difference to the best (px)");
  for (const auto& column : columns) head.emplace_back(column.second);
  std::string out = "<h2>Results</h2>\n<div class=\"wide\"><table class=\"numbers\">\n<thead>" +
                    table_row(head, "th") + "</thead><tbody>\n";
  for (const Combination& c : r.combinations) {
    std::vector<std::string> cells{escape_markup(c.controller), fmt::format("{} of {}", c.settled, c.trials)};
    if (head[1] == "condition") cells.insert(cells.begin() + 1, escape_markup(condition(r, c)));
    cells.push_back(c.excess_over_best ? with_interval(&*c.excess_over_best) : "–");
    for (const auto& column : columns) cells.push_back(with_interval(metric_of(c, column.first)));
    out += table_row(cells, "td");
  }
  return out +
         fmt::format(
             "</tbody></table></div>\n<p class=\"note\">Means over {} with 95 % confidence intervals "
             "(Student's t). Settling time: mean over the trials that settled. Difference to the best: "
             "mean difference in steady-state error, for equal seeds, to the controller with the smallest "
             "steady-state error.</p>\n",
             counted(std::uint64_t(r.study.seeds), "seed"));
}

// The combinations grouped by model and delay; those of one group are contiguous.
std::vector<std::vector<const Combination*>> groups(const ControllerComparison& r) {
  std::vector<std::vector<const Combination*>> all;
  for (std::size_t i = 0; i < r.combinations.size(); ++i) {
    if (i % r.study.controllers.size() == 0) all.emplace_back();
    all.back().push_back(&r.combinations[i]);
  }
  return all;
}

constexpr Ink kGroupInks[] = {Ink::blue, Ink::vermillion, Ink::green, Ink::purple, Ink::orange, Ink::sky};

Figure over_time(const ControllerComparison& r, const std::vector<const Combination*>& group, bool distance) {
  Figure f{distance ? "Distance to the setpoint" : "Dispersion", "", {}};
  const std::string where = condition(r, *group.front());
  if (!where.empty()) f.heading += ": " + where;
  f.caption = fmt::format("{} over time, mean over {}. Shaded: one standard deviation between seeds.",
                          distance ? "Distance from the swarm's centroid to the setpoint"
                                   : "Root-mean-square distance of the cells from their centroid",
                          counted(std::uint64_t(r.study.seeds), "seed"));
  f.plot.description = f.heading;
  f.plot.inlined = true;
  f.plot.x.label = "time (s)";
  f.plot.y.label = distance ? "distance (px)" : "dispersion (px rms)";
  f.plot.y.lo = 0;
  for (std::size_t i = 0; i < group.size(); ++i) {
    const auto& mean = distance ? group[i]->distance_px : group[i]->rms_radius_px;
    const auto& sd = distance ? group[i]->distance_sd_px : group[i]->rms_radius_sd_px;
    Ribbon band{group[i]->t_s, {}, {}, {}, kGroupInks[i % std::size(kGroupInks)]};
    for (std::size_t k = 0; k < mean.size(); ++k) {
      band.lo.push_back(std::max(0.0, mean[k] - sd[k]));
      band.hi.push_back(mean[k] + sd[k]);
    }
    f.plot.add(std::move(band));
  }
  for (std::size_t i = 0; i < group.size(); ++i)
    f.plot.add(Line{.x = group[i]->t_s,
                    .y = distance ? group[i]->distance_px : group[i]->rms_radius_px,
                    .label = group[i]->controller,
                    .ink = kGroupInks[i % std::size(kGroupInks)]});
  return f;
}

Figure against_delay(const ControllerComparison& r, const Variant& model) {
  Figure f{"Steady-state error against delay",
           "Root mean square of the distance over the last third of the run, mean over the seeds. Bars: "
           "95 % confidence interval of the mean.",
           {}};
  if (r.study.models.size() > 1) f.heading += ": " + model.name;
  f.plot.description = f.heading;
  f.plot.inlined = true;
  f.plot.x.label = "delay (frames)";
  f.plot.x.ticks = Ticks::integers;
  f.plot.y.label = "steady-state error (px rms)";
  f.plot.y.lo = 0;
  for (std::size_t i = 0; i < r.study.controllers.size(); ++i) {
    const Ink ink = kGroupInks[i % std::size(kGroupInks)];
    Line line{.x = {}, .y = {}, .label = r.study.controllers[i].name, .ink = ink};
    ErrorBars bars{{}, {}, {}, {}, ink};
    for (const Combination& c : r.combinations)
      if (c.model == model.name && c.controller == line.label)
        if (const MeanOverSeeds* m = metric_of(c, "steady_rms_px")) {
          line.x.push_back(c.delay);
          line.y.push_back(m->mean);
          bars.x.push_back(c.delay);
          bars.lo.push_back(m->ci95[0]);
          bars.hi.push_back(m->ci95[1]);
        }
    f.plot.add(std::move(bars));
    f.plot.add(Scatter{.x = line.x, .y = line.y, .label = {}, .ink = line.ink});
    f.plot.add(std::move(line));
  }
  return f;
}

// The controller with the smallest steady-state error: a sentence, or a table row for each model and delay.
std::string verdict(const ControllerComparison& r) {
  std::string rows, sentence;
  for (const auto& group : groups(r)) {
    const Combination* best = nullptr;
    bool significant = true;
    for (const Combination* c : group) {
      if (!c->excess_over_best && metric_of(*c, "steady_rms_px")) best = c;
      if (c->excess_over_best && c->excess_over_best->ci95[0] <= 0) significant = false;
    }
    if (!best || group.size() < 2) continue;
    const MeanOverSeeds& least = *metric_of(*best, "steady_rms_px");
    const std::string at =
        fmt::format("{} px rms{}", with_uncertainty(least.mean, least.mean - least.ci95[0], "±"),
                    significant ? "" : " (not significantly smaller than all others)");
    sentence = fmt::format(
        "<p class=\"lead\">{} has the smallest steady-state error, {}.</p>\n<p class=\"note\">± is half of "
        "the "
        "95 % confidence interval of the mean.</p>\n",
        escape_markup(best->controller), at);
    rows += table_row(
        {escape_markup(condition(r, *best)), fmt::format("{}, {}", escape_markup(best->controller), at)},
        "td");
  }
  if (groups(r).size() < 2 || rows.empty()) return sentence;
  return "<p class=\"lead\">Controller with the smallest steady-state error</p>\n<table "
         "class=\"facts\"><tbody>\n" +
         rows +
         "</tbody></table>\n<p class=\"note\">± is half of the 95 % confidence interval of the mean.</p>\n";
}

}  // namespace

nlohmann::ordered_json controllers_json(const ControllerComparison& r) {
  Json j{{"title", r.study.title},
         {"seeds", r.study.seeds},
         {"notes", r.notes},
         {"combinations", Json::array()}};
  for (const Combination& c : r.combinations) {
    Json one{{"controller", c.controller},
             {"model", c.model},
             {"delay_frames", c.delay},
             {"trials", c.trials},
             {"settled", c.settled},
             {"settled_ci95", c.settled_ci95},
             {"metrics", Json::object()},
             {"excess_over_best_px", c.excess_over_best ? mean_json(*c.excess_over_best) : Json()}};
    for (const auto& [name, m] : c.metrics) one["metrics"][name] = mean_json(m);
    if (!c.baseline.empty()) {
      one["baseline"] = c.baseline;
      for (const auto& [name, m] : c.minus_baseline) one["minus_baseline"][name] = mean_json(m);
    }
    j["combinations"].push_back(std::move(one));
  }
  return j;
}

std::string controllers_csv(const ControllerComparison& r) {
  const auto quoted = [](const std::string& text) {
    std::string out = "\"";
    for (const char ch : text) out += ch == '"' ? std::string("\"\"") : std::string(1, ch);
    return out + "\"";
  };
  std::string out = "controller,model,delay_frames,metric,mean,sd,ci95_low,ci95_high,n\n";
  for (const Combination& c : r.combinations)
    for (const auto& [name, m] : c.metrics)
      out += fmt::format("{},{},{},{},{:.9g},{:.9g},{:.9g},{:.9g},{}\n", quoted(c.controller),
                         quoted(c.model), c.delay, name, m.mean, m.sd, m.ci95[0], m.ci95[1], m.n);
  return out;
}

std::vector<Figure> controllers_figures(const ControllerComparison& r) {
  std::vector<Figure> figures;
  for (const auto& group : groups(r))
    for (const bool distance : {true, false}) figures.push_back(over_time(r, group, distance));
  if (several_delays(r))
    for (const Variant& model : r.study.models) figures.push_back(against_delay(r, model));
  return figures;
}

std::string controllers_page(const ControllerComparison& r, const Provenance& provenance) {
  std::string out = fmt::format("<h1>{}</h1>\n", escape_markup(r.study.title)) + verdict(r) + table(r) +
                    "<h2>Figures</h2>\n";
  int number = 0;
  out += "<div class=\"figures\">\n";
  out += figures_markup(controllers_figures(r), number) + "</div>\n";
  for (const std::string& note : r.notes)
    out += fmt::format("<p class=\"warning\">{}</p>\n", escape_markup(note));
  return html_page(r.study.title, out + provenance_markup(provenance));
}

}  // namespace faba
