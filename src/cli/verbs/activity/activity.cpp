#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <algorithm>
#include <cmath>
#include <string>

#include "cli/command_line.h"
#include "cli/output_file.h"
#include "cli/progress.h"
#include "cli/provenance.h"
#include "cli/quality_text.h"
#include "cli/verbs/activity/activity_verb.h"
#include "core/error.h"
#include "core/file.h"
#include "study/data/run_video.h"
#include "study/experiment/experiment.h"
#include "study/motion/activity_study.h"
#include "study/pages/activity_report.h"
#include "study/pages/flow_report.h"

namespace faba::cli {
namespace {

std::string line_text(double intercept, double slope) {
  return fmt::format("{:.4g} {} {:.4g} x exposure", intercept, slope < 0 ? '-' : '+', std::fabs(slope));
}

// Rounded to two digits of its uncertainty.
std::string with_error(double value, double se) {
  const int digits = se > 0 ? std::clamp(1 - int(std::floor(std::log10(se))), 0, 6) : 6;
  return fmt::format("{:.{}f} +- {:.{}f}", value, digits, se, digits);
}

std::string with_interval(const Measured& m) {
  const double width = width_of(m.ci90);
  return fmt::format("{} [{}, {}]", decimals(m.value, width), decimals(m.ci90[0], width),
                     decimals(m.ci90[1], width));
}

void print_response(const VideoActivity& a) {
  if (!a.response) return;
  const Response& r = *a.response;
  const char* unit = a.timed ? "s" : "frames";
  if (const auto onset = onset_of(a)) {
    fmt::print("  onset {} {} (90 % interval; {})\n", with_interval({onset->t_s, onset->ci90}), unit,
               r.source == Response::Source::detected
                   ? "time of the field reversal unknown"
                   : fmt::format("field reversal at {:g} {}, {}", r.earliest_s, unit, reversal_source(r)));
  } else {
    fmt::print("  no response to the field reversal\n");
  }
  if (r.fraction)
    fmt::print("  responding fraction {} (90 % interval; {})\n", with_interval(*r.fraction),
               r.fraction_method);
  const std::optional<Measured> um = speed_um_s(a);
  if (r.speed_px_s)
    fmt::print("  speed {} {}/s (90 % interval)\n", with_interval(um ? *um : *r.speed_px_s),
               um ? "um" : "px");
}

void print_video(const VideoActivity& a) {
  fmt::print(
      "{}\n  mean activity {:.4g} px^3 per frame pair (flow above {:.3g} px), direction {} degrees (0 right, "
      "90 "
      "down){}\n",
      a.input.file.string(), a.mean_amount, a.threshold_px, rounded_degrees(a.direction_deg),
      a.signal_to_noise ? fmt::format(", signal-to-noise ratio {:.3g}", *a.signal_to_noise) : "");
  if (const auto per_cell = activity_per_cell(a)) {
    const std::string cells = *a.visible_cells < 1000 ? fmt::format("{:.3g}", *a.visible_cells)
                                                      : fmt::format("{:.0f}", *a.visible_cells);
    fmt::print("  activity per visible cell {:.3g} px^3 ({} {})\n", *per_cell, cells,
               cells == "1" ? "cell" : "cells");
  }
  print_response(a);
  // A time of a video without a frame rate is the number of a frame.
  if (a.fit.good)
    fmt::print("  maximum at {}{}{}, width {:.3g}{} (+- standard error)\n", a.timed ? "" : "frame ",
               with_error(a.fit.peak_s, a.fit.se_peak_s), a.timed ? " s" : "", a.fit.sigma_s,
               a.timed ? " s" : " frames");
  else
    fmt::print("  no time of the maximum: {}\n", a.fit.reason);
  for (const MotionSegment& s : a.segments)
    fmt::print("  {}{:7.2f} to {:7.2f}{}  direction {:3} degrees\n", a.timed ? "" : "frame ", s.t0_s, s.t1_s,
               a.timed ? " s" : "", rounded_degrees(s.direction_deg));
  if (a.segments.empty())
    fmt::print("  no motion segment: at no time does more than half of the motion have one direction\n");
}

void print_line(const char* quantity, const std::optional<ExposureLine>& line) {
  if (!line) return;
  fmt::print("{} = {}; 95 % interval of the slope {:.4g} to {:.4g}\n", quantity,
             line_text(line->intercept, line->slope), line->slope_ci95[0], line->slope_ci95[1]);
}

void summary(const ActivityResult& r) {
  for (const VideoActivity& a : r.videos) print_video(a);
  print_line("time of the maximum", r.peak_line);
  if (r.peak_line && r.frame_s && r.videos.front().timed)
    fmt::print("  in frames at {:.3g} Hz: {}\n", 1 / *r.frame_s,
               line_text(r.peak_line->intercept / *r.frame_s, r.peak_line->slope / *r.frame_s));
  print_line("mean activity", r.mean_line);
  print_line("mean activity per visible cell", r.per_cell_line);
  if (r.cutoff)
    fmt::print("cut-off at {:.4g} s air exposure time; videos on the wrong side of it: {}\n",
               r.cutoff->cutoff_s, r.cutoff->wrong);
}

int activity(const ActivityVerb& v, const Common& c) {
  check_engine(v.engine);
  if (v.engine.engine.empty() && !v.folder.empty())
    throw Error(Errc::usage, "--folder", "requires --engine, such as --engine local");
  std::vector<std::filesystem::path> inputs = v.videos;
  inputs.push_back(v.noise);
  check_distinct({v.out, v.report, v.picture});
  check_output(v.out, {".csv"}, v.force, inputs);
  check_output(v.report, {".html"}, v.force, inputs);
  check_output(v.picture, {".png"}, v.force, inputs);
  ActivityJob job = job_of(v);
  // A video of a dead sample may be measured with others, as a control.
  std::error_code ec;
  if (!v.noise.empty() && job.videos.size() == 1 &&
      std::filesystem::equivalent(v.noise, job.videos.front().file, ec))
    throw Error(
        Errc::usage, "--noise",
        fmt::format("{} is the measured video itself; give a video of a dead sample", v.noise.string()));
  if (!v.picture.empty() && job.videos.size() != 1)
    throw Error(Errc::usage, "--picture",
                fmt::format("requires a single video, but {} are given", job.videos.size()));
  expect_videos();
  if (!v.engine.engine.empty()) return activity_on_engine(v, c);
  Provenance provenance;
  if (c.json || !v.report.empty()) provenance = provenance_of(c, inputs_of(v, job));
  Progress bar("measuring", !c.quiet && !c.json);
  job.progress = [&](std::size_t video, std::uint64_t done, std::uint64_t total) {
    if (total > 0) bar.update(video * total + std::min(done, total), job.videos.size() * total);
  };
  job.stop = [&stop = stop_requested()] { return stop.load(); };
  const ActivityResult result = measure_activity(job);
  bar.clear();
  if (!v.out.empty()) write_file(v.out, activity_csv(result));
  if (!v.report.empty()) write_file(v.report, activity_page(result, provenance));
  if (!v.picture.empty()) write_activity_picture(v.picture, result.videos.front());
  if (c.json) {
    print_json(activity_json(result), provenance);
    return 0;
  }
  if (c.quiet) return 0;
  print_activity(result);
  for (const auto& file : {v.out, v.report, v.picture})
    if (!file.empty()) fmt::print("wrote {}\n", file.string());
  return 0;
}

}  // namespace

ActivityJob job_of(const ActivityVerb& v) {
  ActivityJob job;
  const FlowChoice choice{v.flow.method, v.flow.values};
  job.method = flow_part(choice, published_flow());
  job.options_text = options_text(choice, v.flow.shrink, v.flow.fps);
  job.frames = !v.picture.empty();
  job.noise = v.noise;
  job.shrink = v.flow.shrink;
  job.fps = v.flow.fps;
  job.threads = v.flow.threads;
  if (v.videos.size() == 1 && v.videos.front().extension() == ".toml") {
    read_activity_study(v.videos.front(), job);
    if (!choice.values.empty()) job.method = flow_part(choice, published_flow());
    if (!v.noise.empty()) {
      job.noise = v.noise;
      job.threshold_px.reset();
    }
  } else {
    for (const auto& video : v.videos)
      if (video.extension() == ".toml")
        throw Error(Errc::usage, video.string(), "is a study file; give either one study file or videos");
    for (const auto& video : v.videos) job.videos.push_back({.file = video});
  }
  for (ActivityInput& input : job.videos) {
    const PartOptions part{v.flow.part.from ? v.flow.part.from : input.from_s,
                           v.flow.part.to ? v.flow.part.to : input.to_s};
    input.from_s = part.part().from_s;
    input.to_s = part.to;
    if (v.response.direction) input.direction_deg = v.response.direction;
    if (v.reversal) input.reversal_s = v.reversal;
    if (input.reversal_s && input.to_s && *input.reversal_s >= *input.to_s)
      throw Error(Errc::usage, "--reversal",
                  fmt::format("{:g} s is not before the end of the evaluation, {:g} s", *input.reversal_s,
                              *input.to_s));
  }
  if (v.response.flow_threshold) job.threshold_px = v.response.flow_threshold;
  return job;
}

std::vector<std::filesystem::path> inputs_of(const ActivityVerb& v, const ActivityJob& job) {
  std::vector<std::filesystem::path> inputs = v.videos;
  inputs.push_back(v.noise);
  for (const ActivityInput& input : job.videos) inputs.push_back(input.file);
  inputs.push_back(job.noise);
  return inputs;
}

void print_activity(const ActivityResult& result) {
  for (const VideoActivity& a : result.videos)
    for (const std::string& note : a.notes)
      print_stderr(fmt::format("faba: note: {}: {}", a.input.file.string(), note));
  summary(result);
  print_quality(all_warnings(result));
}

void add_activity_options(CLI::App* v, ActivityVerb& o) {
  v->add_option(
       "videos", o.videos,
       "Videos, run directories or flow files; or a study file (TOML) or an experiment that lists them")
      ->required()
      // The folder of an experiment stands for its file.
      ->transform([](const std::string& path) { return experiment_file(path).value_or(path).string(); });
  add_response_options(v, o.response);
  v->add_option("--reversal", o.reversal,
                "Time of the field reversal in the video, s; default: as recorded by a run, else unknown")
      ->check(between(0, 1e9))
      ->transform(in_seconds);
  v->add_option("--noise", o.noise, "Video of a dead sample, from which the threshold is measured")
      ->check(not_empty)
      ->excludes("--flow-threshold");
  v->add_option("-o,--out", o.out, "Write the activity signatures, as CSV")->check(not_empty);
  v->add_option("--report", o.report, "Write a page with all figures, as HTML")->check(not_empty);
  v->add_option("--picture", o.picture,
                "Single video: write the flow of the pair with the largest activity, before and after "
                "filtering, as PNG")
      ->check(not_empty);
  v->add_flag("--force", o.force, "Replace existing files, and with --folder the results of another study");
  v->add_option(
       "--folder", o.folder,
       "With --engine: directory of the study; default: runs/activity. An incomplete study is resumed")
      ->check(not_empty);
  add_engine_options(v, o.engine);
  add_flow_options(v, o.flow, published_flow());
}

void add_activity(CLI::App& app, CommandLine& line) {
  const auto o = std::make_shared<ActivityVerb>();
  CLI::App* v =
      verb(app, line, "activity",
           "Measure when cells in videos move in one direction, how much, and when the motion is largest",
           "  faba activity film.mp4 --report activity.html\n"
           "  faba activity film.mp4 --direction 90 --reversal \"1 s\"\n"
           "  faba activity film.mp4 --direction 90 --noise dead.mp4 --out signature.csv\n"
           "  faba activity study.toml --report study.html --engine local");
  add_activity_options(v, *o);
  v->callback([o, &line] { line.code = activity(*o, line.common); });
}

}  // namespace faba::cli
