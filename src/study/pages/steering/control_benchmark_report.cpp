#include "study/pages/steering/control_benchmark_report.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <optional>

#include "core/counted.h"
#include "core/toml.h"
#include "study/pages/provenance_output.h"
#include "study/pages/steering/controller_report.h"
#include "study/plot/figure.h"
#include "study/plot/markup.h"
#include "study/plot/report_page.h"
#include "study/quality/rounded.h"
#include "study/steering/metric_list.h"

namespace faba {
namespace {

using BenchmarkCells = std::vector<std::string>;
struct ResultTable {
  BenchmarkCells head;
  std::vector<BenchmarkCells> rows;
};

// Columns of a case; those that are undefined or zero in all rows are left out.
constexpr const char* kResultColumns[] = {
    "settling_time_s",     "steady_rms_px", "steady_max_px",    "cross_track_95_px", "rms_radius_px",
    "control_effort_a2_s", "coil_heat_w",   "limited_fraction", "keep_out_fraction", "keep_out_cells"};

std::string heading(const MetricInfo& m) {
  return m.unit[0] ? fmt::format("{}, {}", m.name, m.unit) : m.name;
}

// Four digits are enough, also where the interval is narrower.
std::string benchmark_mean(const MeanOverSeeds& m, double shown) {
  const double mean = shown * m.mean, half = shown * (m.mean - m.ci95[0]);
  return half < 1e-3 * std::abs(mean) ? fmt::format("{:.4g}", mean) : with_uncertainty(mean, half, "±");
}

std::string cell_of(const Combination& c, const std::string& key, double shown) {
  const auto it = c.metrics.find(key);
  return it == c.metrics.end() ? "–" : benchmark_mean(it->second, shown);
}

std::string difference_text(const MeanOverSeeds& d, double shown) {
  const RoundedInterval t = rounded_interval(shown * d.mean, {shown * d.ci95[0], shown * d.ci95[1]});
  return fmt::format("{} ({} to {})", t.value, t.low, t.high);
}

ResultTable results_of(const BenchmarkCase& one, const ControllerComparison& r) {
  std::vector<const MetricInfo*> columns;
  for (const char* key : kResultColumns)
    if (std::any_of(r.combinations.begin(), r.combinations.end(),
                    [&](const Combination& c) {
                      const auto it = c.metrics.find(key);
                      return it != c.metrics.end() && it->second.mean != 0;
                    }) ||
        (std::string_view(key).starts_with("keep_out") && !one.study.keep_out_px.empty()))
      columns.push_back(&metric(key));
  ResultTable t{{"controller", "delay, frames", "settled"}, {}};
  for (const MetricInfo* m : columns) t.head.push_back(heading(*m));
  if (one.speed) t.head.insert(t.head.end(), {"rms distance / speed, s", "largest distance / speed, s"});
  for (const Combination& c : r.combinations) {
    BenchmarkCells row{c.controller, fmt::format("{}", c.delay), fmt::format("{}/{}", c.settled, c.trials)};
    for (const MetricInfo* m : columns) row.push_back(cell_of(c, m->key, m->shown));
    if (one.speed)
      for (const char* key : {"steady_rms_px", "steady_max_px"})
        row.push_back(cell_of(c, key, 1e-6 * r.um_per_px / *one.speed));
    t.rows.push_back(std::move(row));
  }
  return t;
}

// Controllers against the best of the baseline: differences of the error and of the settling time.
ResultTable baseline_of(const BenchmarkCase& one, const ControllerComparison& r) {
  std::vector<std::string> keys{one.study.ranked_by};
  if (keys.front() != "settling_time_s") keys.emplace_back("settling_time_s");
  ResultTable t{{"controller", "delay, frames", "minus"}, {}};
  for (const std::string& key : keys) t.head.push_back(heading(metric(key)));
  for (const Combination& c : r.combinations) {
    if (c.baseline.empty()) continue;
    BenchmarkCells row{c.controller, fmt::format("{}", c.delay), c.baseline};
    for (const std::string& key : keys) {
      const auto it = c.minus_baseline.find(key);
      row.push_back(it == c.minus_baseline.end() ? "–" : difference_text(it->second, metric(key).shown));
    }
    t.rows.push_back(std::move(row));
  }
  return t;
}

std::string ms(double s) { return fmt::format("{:.3g}", 1e3 * s); }

// Of all delays the one with the longest time.
ResultTable cycles_of(const std::vector<CycleTime>& cycles) {
  ResultTable t{{"case", "controller", "median, ms", "99.9 %, ms", "largest, ms", "frame, ms"}, {}};
  for (const CycleTime& c : cycles) {
    const bool longest = std::none_of(cycles.begin(), cycles.end(), [&](const CycleTime& other) {
      return other.name == c.name && other.controller == c.controller && other.most > c.most;
    });
    if (longest)
      t.rows.push_back({c.name, c.controller, ms(c.median), ms(c.most), ms(c.worst), ms(c.frame_period)});
  }
  return t;
}

struct ConstraintRow {
  std::string controller;
  int trials = 0;
  std::optional<double> limited = {};   ///< largest mean of a case; empty: not defined in any
  std::optional<double> keep_out = {};  ///< the same
};

void raise(std::optional<double>& largest, const Combination& c, const char* key) {
  const auto it = c.metrics.find(key);
  if (it != c.metrics.end()) largest = std::max(largest.value_or(0), it->second.mean);
}

std::string percent_cell(const std::optional<double>& fraction) {
  return fraction ? fmt::format("{:.3g}", 100 * *fraction) : "–";
}

// Every controller over all cases. The fractions are not negative: a mean of zero is zero in every trial.
ResultTable constraints_of(const ControlBenchmarkResult& r) {
  std::vector<ConstraintRow> rows;
  for (const ControllerComparison& one : r.cases)
    for (const Combination& c : one.combinations) {
      auto it = std::find_if(rows.begin(), rows.end(),
                             [&](const ConstraintRow& row) { return row.controller == c.controller; });
      if (it == rows.end()) it = rows.insert(it, {.controller = c.controller});
      it->trials += c.trials;
      raise(it->limited, c, "limited_fraction");
      raise(it->keep_out, c, "keep_out_fraction");
    }
  ResultTable t{{"controller", "trials", "Limited, %", "Mean in a forbidden region, %"}, {}};
  for (const ConstraintRow& row : rows)
    t.rows.push_back({row.controller, fmt::format("{}", row.trials), percent_cell(row.limited),
                      percent_cell(row.keep_out)});
  return t;
}

constexpr const char* kConstraints =
    "All cases together: frames in which the limits of current and slew rate have changed the command, and "
    "frames in which the mean of the cells was in a forbidden region; the largest mean of a case. 0: in no "
    "frame of any trial.";

std::string markdown_row(const BenchmarkCells& row) { return fmt::format("| {} |\n", fmt::join(row, " | ")); }

std::string markdown(const ResultTable& t) {
  std::string out = markdown_row(t.head) + "|";
  for (std::size_t i = 0; i < t.head.size(); ++i) out += "---|";
  out += "\n";
  for (const BenchmarkCells& row : t.rows) out += markdown_row(row);
  return out;
}

std::string markup(const ResultTable& t) {
  BenchmarkCells head = t.head;
  for (std::string& cell : head) cell = escape_markup(cell);
  std::string out =
      "<div class=\"wide\"><table class=\"numbers\"><thead>" + table_row(head, "th") + "</thead><tbody>\n";
  for (BenchmarkCells row : t.rows) {
    for (std::string& cell : row) cell = escape_markup(cell);
    out += table_row(row, "td");
  }
  return out + "</tbody></table></div>\n";
}

std::string notes_of_tables(const ControlBenchmarkResult& r) {
  const ControllerStudy& s = r.benchmark.cases.front().study;
  return fmt::format(
      "Means over {} (from seed {}) ± half of the 95 % confidence interval of the mean; a settling time is "
      "the mean over "
      "the trials that settled. Differences are paired by the seeds, with their 95 % interval in "
      "parentheses.",
      counted(std::uint64_t(s.seeds), "seed"), s.first_seed);
}

}  // namespace

nlohmann::ordered_json control_benchmark_json(const ControlBenchmarkResult& r) {
  Json j{{"title", r.benchmark.title}, {"version_of_cases", r.benchmark.version}, {"cases", Json::array()}};
  for (std::size_t i = 0; i < r.cases.size(); ++i) {
    const BenchmarkCase& one = r.benchmark.cases[i];
    Json c{{"name", one.name}, {"about", one.about}, {"ranked_by", one.study.ranked_by}};
    c["literature"] = one.literature;
    c["speed_um_per_s"] = one.speed ? Json(1e6 * *one.speed) : Json();
    c.update(controllers_json(r.cases[i]));
    j["cases"].push_back(std::move(c));
  }
  return j;
}

std::string control_benchmark_markdown(const ControlBenchmarkResult& r,
                                       const std::vector<CycleTime>& cycles) {
  std::string out =
      fmt::format("# {}\n\nGenerated by `faba benchmark-control`. Version {} of the cases. {}\n",
                  r.benchmark.title, r.benchmark.version, notes_of_tables(r));
  for (std::size_t i = 0; i < r.cases.size(); ++i) {
    const BenchmarkCase& one = r.benchmark.cases[i];
    out += fmt::format("\n## {}\n\n{}\n\n{}", one.name, one.about, markdown(results_of(one, r.cases[i])));
    if (const ResultTable t = baseline_of(one, r.cases[i]); !t.rows.empty())
      out += "\nDifferences to the best controller of the baseline:\n\n" + markdown(t);
    if (!one.literature.empty()) out += "\n" + one.literature + "\n";
    for (const std::string& note : r.cases[i].notes) out += "\nNote: " + note + "\n";
  }
  out += fmt::format("\n## Constraints\n\n{}\n\n{}", kConstraints, markdown(constraints_of(r)));
  if (!cycles.empty())
    out +=
        "\n## Time of a control cycle\n\nEstimator and controller together, one trial of each combination on "
        "one thread "
        "of the machine that wrote this page.\n\n" +
        markdown(cycles_of(cycles));
  return out;
}

std::string control_benchmark_page(const ControlBenchmarkResult& r, const std::vector<CycleTime>& cycles,
                                   const Provenance& provenance) {
  std::string out = fmt::format("<h1>{}</h1>\n<p class=\"note\">Version {} of the cases. {}</p>\n",
                                escape_markup(r.benchmark.title), r.benchmark.version, notes_of_tables(r));
  int number = 0;
  for (std::size_t i = 0; i < r.cases.size(); ++i) {
    const BenchmarkCase& one = r.benchmark.cases[i];
    out += fmt::format("<h2>{}</h2>\n<p>{}</p>\n{}", escape_markup(one.name), escape_markup(one.about),
                       markup(results_of(one, r.cases[i])));
    if (const ResultTable t = baseline_of(one, r.cases[i]); !t.rows.empty())
      out += "<p>Differences to the best controller of the baseline:</p>\n" + markup(t);
    if (!one.literature.empty())
      out += fmt::format("<p class=\"note\">{}</p>\n", escape_markup(one.literature));
    out += "<div class=\"figures\">\n" + figures_markup(controllers_figures(r.cases[i]), number) + "</div>\n";
    for (const std::string& note : r.cases[i].notes)
      out += fmt::format("<p class=\"warning\">{}</p>\n", escape_markup(note));
  }
  out += fmt::format("<h2>Constraints</h2>\n<p>{}</p>\n{}", kConstraints, markup(constraints_of(r)));
  if (!cycles.empty()) out += "<h2>Time of a control cycle</h2>\n" + markup(cycles_of(cycles));
  return html_page(r.benchmark.title, out + provenance_markup(provenance));
}

std::string cycle_times_csv(const std::vector<CycleTime>& cycles) {
  std::string out = "case,controller,delay_frames,median_s,quantile_999_s,largest_s,frame_period_s\n";
  for (const CycleTime& c : cycles)
    out += fmt::format("\"{}\",\"{}\",{},{:.4g},{:.4g},{:.4g},{:.6g}\n", c.name, c.controller, c.delay,
                       c.median, c.most, c.worst, c.frame_period);
  return out;
}

}  // namespace faba
