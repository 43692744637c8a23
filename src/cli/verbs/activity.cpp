#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <cmath>
#include <string>

#include "cli/command_line.h"
#include "cli/options/flow.h"
#include "cli/output_file.h"
#include "cli/progress.h"
#include "cli/quality_text.h"
#include "core/error.h"
#include "core/file.h"
#include "study/motion/activity_study.h"
#include "study/pages/activity_report.h"
#include "study/pages/flow_report.h"

namespace faba::cli {
namespace {

struct ActivityVerb {
  std::vector<std::filesystem::path> videos;  ///< or one study file
  std::filesystem::path noise, out, report, picture;
  ResponseOptions response;
  FlowOptions flow;
  bool force = false;
};

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
  }
  if (v.response.flow_threshold) job.threshold_px = v.response.flow_threshold;
  return job;
}

std::string line_text(double intercept, double slope) {
  return fmt::format("{:.4g} {} {:.4g} x exposure", intercept, slope < 0 ? '-' : '+', std::fabs(slope));
}

// A time of a video without a frame rate is the number of a frame.
std::string time_text(const VideoActivity& a, double t, double se) {
  return a.timed ? fmt::format("at {:.3g} +- {:.2g} s", t, se)
                 : fmt::format("at frame {:.3g} +- {:.2g}", t, se);
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
  if (a.fit.good)
    fmt::print("  {}maximum {}, width {:.3g} {}\n",
               a.onset_s ? fmt::format("onset {}, ", time_text(a, *a.onset_s, *a.se_onset_s)) : "",
               time_text(a, a.fit.peak_s, a.fit.se_peak_s), a.fit.sigma_s, a.timed ? "s" : "frames");
  else
    fmt::print("  no Gaussian fit: {}; onset and time of the maximum are unknown\n", a.fit.reason);
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
  Progress bar("measuring", !c.quiet && !c.json);
  job.progress = [&](std::size_t video, std::uint64_t done, std::uint64_t total) {
    if (total > 0) bar.update(video * total + std::min(done, total), job.videos.size() * total);
  };
  job.stop = [&stop = stop_requested()] { return stop.load(); };
  const ActivityResult result = measure_activity(job);
  bar.clear();
  if (!v.out.empty()) write_file(v.out, activity_csv(result));
  if (!v.report.empty()) write_file(v.report, activity_page(result));
  if (!v.picture.empty()) write_activity_picture(v.picture, result.videos.front());
  if (c.json) {
    fmt::print("{}\n", activity_json(result).dump());
    return 0;
  }
  if (c.quiet) return 0;
  for (const VideoActivity& a : result.videos)
    for (const std::string& note : a.notes)
      print_stderr(fmt::format("faba: note: {}: {}", a.input.file.string(), note));
  summary(result);
  print_quality(all_warnings(result));
  for (const auto& file : {v.out, v.report, v.picture})
    if (!file.empty()) fmt::print("wrote {}\n", file.string());
  return 0;
}

}  // namespace

void add_activity(CLI::App& app, CommandLine& line) {
  const auto o = std::make_shared<ActivityVerb>();
  CLI::App* v =
      verb(app, line, "activity",
           "Measure when cells in videos move in one direction, how much, and when the motion is largest",
           "  faba activity film.mp4 --report activity.html\n"
           "  faba activity film.mp4 --direction 90 --noise dead.mp4 --out signature.csv\n"
           "  faba activity study.toml --report study.html");
  v->add_option("videos", o->videos,
                "Videos, run directories or flow files; or a study file (TOML) that lists them")
      ->required();
  add_response_options(v, o->response);
  v->add_option("--noise", o->noise, "Video of a dead sample, from which the threshold is measured")
      ->check(not_empty)
      ->excludes("--flow-threshold");
  v->add_option("-o,--out", o->out, "Write the activity signatures, as CSV")->check(not_empty);
  v->add_option("--report", o->report, "Write a page with all figures, as HTML")->check(not_empty);
  v->add_option("--picture", o->picture,
                "Single video: write the flow of the pair with the largest activity, before and after "
                "filtering, as PNG")
      ->check(not_empty);
  v->add_flag("--force", o->force, "Replace existing files");
  add_flow_options(v, o->flow, published_flow());
  v->callback([o, &line] { line.code = activity(*o, line.common); });
}

}  // namespace faba::cli
