#include "study/pages/compare_report.h"

#include <fmt/format.h>

#include <numeric>

#include "core/counted.h"
#include "core/toml.h"
#include "study/pages/provenance_output.h"
#include "study/pages/quality_output.h"
#include "study/plot/figure.h"
#include "study/plot/inline_picture.h"
#include "study/plot/markup.h"
#include "study/plot/plot_svg.h"
#include "study/plot/report_page.h"
#include "vision/draw/flow_picture.h"

namespace faba {
namespace {

std::string name_of(const std::filesystem::path& file) {
  const std::string name = file.filename().string();
  return name.empty() ? file.parent_path().filename().string() : name;
}

Plot distances(const Comparison& c) {
  Plot p;
  p.inlined = true;
  p.width = 620;
  p.height = 300;
  p.x.label = "time after the alignment (s)";
  p.y.label = "distance";
  p.y.lo = 0;
  for (const ComparedRun& r : c.runs) {
    p.add(Line{.x = r.distance.t_s, .y = r.distance.value, .label = name_of(r.file), .width = 1.2});
    const LineFit& fit = r.distance.line;
    const std::vector<double>& t = r.distance.t_s;
    p.add(Line{.x = {t.front(), t.back()},
               .y = {fit.intercept, fit.intercept + fit.slope * double(t.size() - 1)},
               .label = c.runs.size() == 1 ? "straight line fitted to it" : "",
               .ink = Ink::muted,
               .dashed = true});
  }
  p.add(Line{.x = c.naive.t_s,
             .y = c.naive.value,
             .label = "video without motion",
             .ink = Ink::muted,
             .width = 1.2});
  if (c.noise_floor) p.add(Rule{.at = *c.noise_floor, .label = "noise floor", .of_x = false});
  return p;
}

std::vector<double> bins(std::size_t n) {
  std::vector<double> x(n);
  std::iota(x.begin(), x.end(), 0.0);
  return x;
}

Plot histogram(const char* axis, const std::vector<double>& reference, const std::vector<double>& run) {
  Plot p;
  p.inlined = true;
  p.height = 190;
  p.x.label = axis;
  p.y.label = "flow (px × px)";
  p.add(Line{
      .x = bins(reference.size()), .y = reference, .label = "reference", .ink = Ink::blue, .width = 1.2});
  p.add(Line{.x = bins(run.size()), .y = run, .label = "run", .ink = Ink::vermillion, .width = 1.2});
  return p;
}

/// `number`: of the last figure; counted on.
std::string pictures(const ComparedRun& r, const FlowFilter& filter, int& number) {
  FlowDrawing how;
  how.arrow_step_px = 0;
  how.full_px = std::max({full_speed(r.furthest.reference), full_speed(r.furthest.run), 1e-6});
  std::string out =
      fmt::format("<h2>{}: filtered flow at the largest distance, {:.2f} s</h2>\n<div class=\"figures\">\n",
                  escape_markup(name_of(r.file)), r.furthest.t_s);
  const std::pair<const Flow*, const char*> both[] = {{&r.furthest.reference, "Reference"},
                                                      {&r.furthest.run, "Run"}};
  for (const auto& [flow, heading] : both)
    out += fmt::format(
        "<figure>\n<h3>{0}</h3>\n{1}<figcaption>Figure {2}. Flow within 45° of the direction, {3:.0f}° in "
        "the picture "
        "frame (0 right, 90 down).</figcaption>\n"
        "</figure>\n",
        heading, inline_picture(draw_flow(filtered_flow(*flow, filter), how), heading), ++number,
        filter.direction_deg);
  const auto sums = [&](const char* heading, const char* over, const Plot& plot) {
    return figure_markup(
        {heading,
         fmt::format("Sums of the filtered flows of reference and run over the pixels of each {}. "
                     "The distance over time compares these sums.",
                     over),
         plot},
        ++number);
  };
  out += sums("Flow by column", "column",
              histogram("column (px)", r.furthest.reference_bins.x, r.furthest.run_bins.x));
  out +=
      sums("Flow by row", "row", histogram("row (px)", r.furthest.reference_bins.y, r.furthest.run_bins.y));
  return out + "</div>\n";
}

std::string table(const Comparison& c) {
  std::string out =
      "<table class=\"numbers\">\n<thead><tr><th>run</th><th>mean</th><th>s.d.</th><th>slope per "
      "frame</th><th>score</th><th>legacy mean</th></tr></thead>\n<tbody>\n";
  const auto line = [&](const std::string& name, const DistanceSeries& d, std::optional<double> score) {
    out += fmt::format(
        "<tr><th scope=\"row\">{}</th><td>{}</td><td>{}</td><td>{}</td><td>{}</td><td>{}</td></tr>\n",
        escape_markup(name), three_digits(d.mean), three_digits(d.sd), three_digits(d.line.slope),
        score ? three_digits(*score) : "–", three_digits(d.legacy_mean));
  };
  for (const ComparedRun& r : c.runs) line(name_of(r.file), r.distance, score_of(c, r));
  line("video without motion", c.naive, {});
  out +=
      "</tbody></table>\n<p>Mean, standard deviation (s.d.) and slope of the "
      "distances in Figure 1. Slope: of the straight line fitted to the distance against the number of the "
      "pair of frames.";
  if (std::any_of(c.runs.begin(), c.runs.end(),
                  [&](const ComparedRun& r) { return score_of(c, r).has_value(); }))
    out +=
        " Score: the mean distance on a scale where 0 is the noise floor, the distance between runs of one "
        "scenario with different seeds, and 1 is the distance to a video without motion. Scores below 0 are "
        "random "
        "variation or the same run; a score of 1 or more is no better than a video without motion.";
  return out + " Legacy mean: the distance as defined in the thesis.</p>\n";
}

}  // namespace

Json compare_json(const Comparison& c, const CompareJob& job) {
  Json j;
  j["reference"] = job.reference.string();
  j["reference_t0_s"] = c.reference_t0_s;
  j["alignment"] = c.alignment;
  j["direction_deg"] = c.filter.direction_deg;
  j["flow_threshold_px"] = c.filter.threshold_px;
  j["m"] = job.m;
  j["threshold"] = job.threshold;
  j["runs"] = Json::array();
  for (const ComparedRun& r : c.runs) {
    const DistanceSeries& d = r.distance;
    const std::optional<double> score = score_of(c, r);
    j["runs"].push_back({{"run", r.file.string()},
                         {"t0_s", r.t0_s},
                         {"pairs", d.t_s.size()},
                         {"mean", d.mean},
                         {"sd", d.sd},
                         {"slope", d.line.slope},
                         {"slope_ci95", d.line.slope_ci95()},
                         {"intercept", d.line.intercept},
                         {"score", score ? Json(*score) : Json()},
                         {"legacy",
                          {{"mean", d.legacy_mean},
                           {"sd", d.legacy_sd},
                           {"slope", d.legacy_line.slope},
                           {"intercept", d.legacy_line.intercept}}}});
    add_scale(j["runs"].back(), r.scale);
    add_quality(j["runs"].back(), r.warnings);
    j["runs"].back()["notes"] = r.notes;
  }
  j["floor"] = c.noise_floor ? Json(*c.noise_floor) : Json();
  j["floor_from"] = c.noise_floor_from;
  j["naive"] = c.naive.mean;
  add_quality(j, all_warnings(c));
  j["notes"] = c.notes;
  return j;
}

std::string compare_page(const Comparison& c, const CompareJob& job, const Provenance& provenance) {
  std::string out = fmt::format("<h1>Comparison with {}</h1>\n", escape_markup(name_of(job.reference)));
  out += fmt::format(
      "<p class=\"lead\">{} compared with the reference, {}.</p>\n",
      c.runs.size() == 1 ? escape_markup(name_of(c.runs.front().file)) : counted(c.runs.size(), "video"),
      escape_markup(c.alignment));
  out += quality_markup(all_warnings(c));
  for (const std::string& note : c.notes) out += note_markup(note, "", "note");
  for (const ComparedRun& r : c.runs)
    for (const std::string& note : r.notes) out += note_markup(note, name_of(r.file), "note");
  out += fmt::format(
      "<figure class=\"wide\">\n<h3>Distance between the flows over time</h3>\n{}<figcaption>Figure 1. "
      "Quadratic-Chi "
      "distance (m = {:g}, bin similarity threshold {:g} bins) between the sums of the flow over columns and "
      "rows. Dashed lines: straight line fitted to the distance of each run by least squares; its slope is "
      "in "
      "the table. Grey line: a video without motion. Horizontal line, the noise floor: mean distance between "
      "runs of the same scenario with different seeds ({}).</figcaption>\n</figure>\n",
      svg(distances(c)), job.m, job.threshold, escape_markup(c.noise_floor_from));
  out += table(c);
  int number = 1;
  for (const ComparedRun& r : c.runs) out += pictures(r, c.filter, number);
  return html_page("Comparison", out + provenance_markup(provenance));
}

std::string compare_csv(const Comparison& c) {
  std::string out = "run,t_s,distance,legacy\n";
  const auto add = [&](std::size_t number, const DistanceSeries& d) {
    for (std::size_t i = 0; i < d.t_s.size(); ++i)
      out += fmt::format("{},{:.6f},{:.9g},{:.9g}\n", number, d.t_s[i], d.value[i], d.legacy[i]);
  };
  for (std::size_t i = 0; i < c.runs.size(); ++i) add(i + 1, c.runs[i].distance);
  add(0, c.naive);
  return out;
}

}  // namespace faba
