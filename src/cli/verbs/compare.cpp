#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <algorithm>

#include "cli/command_line.h"
#include "cli/options/flow.h"
#include "cli/output_file.h"
#include "cli/progress.h"
#include "cli/provenance.h"
#include "cli/quality_text.h"
#include "core/file.h"
#include "study/motion/direction_text.h"
#include "study/pages/compare_report.h"
#include "study/pages/flow_report.h"
#include "study/quality/rounded.h"

namespace faba::cli {
namespace {

struct CompareVerb {
  std::filesystem::path reference, out, report;
  std::vector<std::filesystem::path> runs;
  ResponseOptions response;
  std::optional<double> reference_t0, t0, duration;
  double m = 0.9, threshold = 3;
  bool no_align = false, no_floor = false;
  FlowOptions flow;
  bool force = false;
};

void print_runs(const Comparison& result) {
  fmt::print("alignment: {}; direction {}, flow threshold {:.3g} px\n", result.alignment,
             direction_text(result.filter.direction_deg), result.filter.threshold_px);
  fmt::print("{:>10} {:>10} {:>12} {:>8}  {}\n", "mean", "s.d.", "slope/frame", "score", "run");
  for (const ComparedRun& r : result.runs) {
    const auto score = score_of(result, r);
    const Rounded mean = rounded(r.distance.mean, r.distance.sd);
    fmt::print("{:>10} {:>10} {:>12.2g} {:>8}  {}\n", mean.value, mean.uncertainty, r.distance.line.slope,
               score ? fmt::format("{:.2f}", *score) : "-", r.file.string());
  }
  if (result.noise_floor)
    fmt::print("{:10.3g} {:43}noise floor: {}\n", *result.noise_floor, "", result.noise_floor_from);
  else
    fmt::print("{:>10} {:43}noise floor: {}\n", "-", "", result.noise_floor_from);
  fmt::print("{:10.3g} {:43}baseline: no motion\n", result.naive.mean, "");
}

int compare(const CompareVerb& v, const Common& c) {
  std::vector<std::filesystem::path> inputs = v.runs;
  inputs.push_back(v.reference);
  check_distinct({v.out, v.report});
  check_output(v.out, {".csv"}, v.force, inputs);
  check_output(v.report, {".html"}, v.force, inputs);
  CompareJob job;
  job.reference = v.reference;
  job.runs = v.runs;
  job.direction_deg = v.response.direction;
  job.flow_threshold_px = v.response.flow_threshold;
  job.reference_t0_s = v.reference_t0;
  job.t0_s = v.t0;
  job.align = !v.no_align;
  if (v.duration) job.duration_s = *v.duration;
  job.m = v.m;
  job.threshold = v.threshold;
  job.method = flow_part({v.flow.method, v.flow.values}, published_flow());
  job.options_text = options_text({v.flow.method, v.flow.values}, v.flow.shrink, v.flow.fps);
  job.shrink = v.flow.shrink;
  job.fps = v.flow.fps;
  job.part = v.flow.part.part();
  job.threads = v.flow.threads;
  job.simulate_noise_floor = !v.no_floor;
  std::string label;
  std::optional<Progress> bar;
  job.progress = [&](const std::string& what, std::uint64_t done, std::uint64_t total) {
    if (what != label || done <= 1) {
      bar.reset();
      bar.emplace(label = what, !c.quiet && !c.json);
    }
    if (total > 0) bar->update(std::min(done, total), total);
  };
  job.stop = [&stop = stop_requested()] { return stop.load(); };
  const Comparison result = compare_videos(job);
  bar.reset();
  if (!v.out.empty()) write_file(v.out, compare_csv(result));
  Provenance provenance;
  if (c.json || !v.report.empty()) {
    std::rotate(inputs.begin(), inputs.end() - 1, inputs.end());  // the reference first
    provenance = provenance_of(c, inputs);
  }
  if (!v.report.empty()) write_file(v.report, compare_page(result, job, provenance));
  if (c.json) {
    print_json(compare_json(result, job), provenance);
    return 0;
  }
  if (c.quiet) return 0;
  for (const std::string& note : result.notes) print_stderr("faba: note: " + note);
  for (const ComparedRun& r : result.runs)
    for (const std::string& note : r.notes)
      print_stderr(fmt::format("faba: note: {}: {}", r.file.string(), note));
  print_runs(result);
  print_quality(all_warnings(result));
  for (const auto& file : {v.out, v.report})
    if (!file.empty()) fmt::print("wrote {}\n", file.string());
  return 0;
}

}  // namespace

void add_compare(CLI::App& app, CommandLine& line) {
  const auto o = std::make_shared<CompareVerb>();
  CLI::App* v =
      verb(app, line, "compare",
           "Distance between the motion in videos or runs and the motion in a reference, frame by frame",
           "  faba compare experiment.mp4 runs/basic-1 runs/basic-2 --report compare.html\n"
           "  faba compare experiment.mp4 simulation.avi --direction 0 --reference-t0 1.2 --t0 0.5");
  v->add_option("reference", o->reference, "Video, run directory or flow file")->required();
  v->add_option("runs", o->runs, "Videos, run directories or flow files to compare with the reference")
      ->required();
  add_response_options(v, o->response);
  v->add_option("--reference-t0", o->reference_t0,
                "Start time in the reference, the first time after the field reversal, s; default: measured")
      ->check(between(0, 1e9))
      ->transform(in_seconds);
  v->add_option("--t0", o->t0, "Start time in the runs, s; default: measured")
      ->check(between(0, 1e9))
      ->transform(in_seconds);
  v->add_flag("--no-align", o->no_align, "Compare from the first frames, without alignment at the reversals")
      ->excludes("--t0")
      ->excludes("--reference-t0");
  v->add_option("--duration", o->duration,
                "Duration of the comparison, s; default: until one of the two videos ends")
      ->check(between(1e-9, 1e9))
      ->transform(in_seconds);
  v->add_option(
      "--m", o->m,
      fmt::format("Exponent of the normalisation of the distance, at least 0 and less than 1; default: {:g}",
                  o->m));
  v->add_option(
      "--threshold", o->threshold,
      fmt::format("Distance of columns or rows at which their similarity is zero, px; default: {:g}",
                  o->threshold));
  v->add_flag("--no-floor", o->no_floor, "Do not simulate the scenario again to measure the noise floor");
  v->add_option("-o,--out", o->out, "Write the distances, as CSV")->check(not_empty);
  v->add_option("--report", o->report, "Write a page with all figures, as HTML")->check(not_empty);
  v->add_flag("--force", o->force, "Replace existing files");
  add_flow_options(v, o->flow, published_flow());
  v->callback([o, &line] { line.code = compare(*o, line.common); });
}

}  // namespace faba::cli
