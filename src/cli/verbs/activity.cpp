#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <cmath>
#include <string>

#include "cli/command_line.h"
#include "cli/options/flow.h"
#include "cli/output_file.h"
#include "cli/progress.h"
#include "core/error.h"
#include "core/file.h"
#include "study/motion/activity_study.h"
#include "study/pages/activity_report.h"
#include "study/pages/flow_report.h"

namespace faba::cli {
namespace {

struct ActivityVerb {
  std::optional<double> from, to;
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
        throw Error(Errc::usage, video.string(), "is a study, which stands alone: one study or videos");
    for (const auto& video : v.videos) job.videos.push_back({.file = video});
  }
  for (ActivityInput& one : job.videos) {
    if (v.from) one.from_s = *v.from;
    if (v.to) one.to_s = *v.to;
    if (one.to_s && *one.to_s <= one.from_s)
      throw Error(Errc::usage, "--from, --to",
                  fmt::format("{:g} s to {:g} s is no time", one.from_s, *one.to_s));
    if (v.response.direction) one.direction_deg = v.response.direction;
  }
  if (v.response.flow_threshold) job.threshold_px = v.response.flow_threshold;
  return job;
}

std::string line_words(double intercept, double slope) {
  return fmt::format("{:.4g} {} {:.4g} x exposure", intercept, slope < 0 ? '-' : '+', std::fabs(slope));
}

void tell_video(const VideoActivity& a) {
  fmt::print("{}\n  mean activity {:.4g} px x px^2 per pair above {:.3g} px, direction {} degrees{}\n",
             a.input.file.string(), a.mean_amount, a.threshold_px, whole_degrees(a.direction_deg),
             a.signal_to_noise ? fmt::format(", signal to noise {:.3g}", *a.signal_to_noise) : "");
  if (const auto per_cell = activity_per_cell(a))
    fmt::print("  {:.3g} per visible cell, of which there are {:.3g}\n", *per_cell, *a.visible_cells);
  if (a.fit.good)
    fmt::print("  maximum at {:.3g} +- {:.2g} s, width {:.3g} s\n", a.fit.peak_s, a.fit.se_peak_s,
               a.fit.sigma_s);
  else
    fmt::print("  no Gaussian: {}\n", a.fit.why);
  for (const MotionSegment& s : a.segments)
    fmt::print("  {:7.2f} to {:7.2f} s  towards {:3} degrees\n", s.t0_s, s.t1_s,
               whole_degrees(s.direction_deg));
  if (a.segments.empty()) fmt::print("  at no time half of all that moves goes one way\n");
}

void tell_line(const char* words, const std::optional<ExposureLine>& line) {
  if (!line) return;
  fmt::print("{} = {}; 95 % of the slope {:.4g} to {:.4g}\n", words, line_words(line->intercept, line->slope),
             line->slope_ci95[0], line->slope_ci95[1]);
}

void summary(const ActivityResult& r) {
  for (const VideoActivity& a : r.videos) tell_video(a);
  tell_line("time of the maximum", r.peak_line);
  if (r.peak_line && r.frame_s)
    fmt::print("  in frames, at {:.3g} per second: {}\n", 1 / *r.frame_s,
               line_words(r.peak_line->intercept / *r.frame_s, r.peak_line->slope / *r.frame_s));
  tell_line("mean activity", r.mean_line);
  tell_line("mean activity per visible cell", r.per_cell_line);
  if (r.cutoff)
    fmt::print("cut-off at {:.4g} s in air; videos that do not fit it: {}\n", r.cutoff->cutoff_s,
               r.cutoff->wrong);
}

int activity(const ActivityVerb& v, const Common& c) {
  std::vector<std::filesystem::path> inputs = v.videos;
  inputs.push_back(v.noise);
  check_distinct({v.out, v.report, v.picture});
  check_output(v.out, ".csv", v.force, inputs);
  check_output(v.report, ".html", v.force, inputs);
  check_output(v.picture, ".png", v.force, inputs);
  ActivityJob job = job_of(v);
  if (!v.picture.empty() && job.videos.size() != 1) throw Error(Errc::usage, "--picture", "is for one video");
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
      tell(fmt::format("faba: note: {}: {}", a.input.file.string(), note));
  summary(result);
  for (const auto& file : {v.out, v.report, v.picture})
    if (!file.empty()) fmt::print("wrote {}\n", file.string());
  return 0;
}

}  // namespace

void add_activity(CLI::App& app, CommandLine& line) {
  const auto o = std::make_shared<ActivityVerb>();
  CLI::App* v = verb(app, line, "activity",
                     "Activity of videos: when something moves in one direction, how much, and when most",
                     "  faba activity film.mp4 --report activity.html\n"
                     "  faba activity film.mp4 --direction 90 --noise dead.mp4 --out signature.csv\n"
                     "  faba activity study.toml --report study.html");
  v->add_option("videos", o->videos,
                "Videos, run directories or files of flows; or a study file (TOML) that lists them")
      ->required();
  add_response_options(v, o->response);
  v->add_option("--noise", o->noise, "A video of a dead sample to find the threshold from")
      ->check(not_empty)
      ->excludes("--flow-threshold");
  v->add_option("--from", o->from, "Leave out what comes before this time, s")
      ->check(between(0, 1e9))
      ->transform(in_seconds);
  v->add_option("--to", o->to, "Leave out what comes after this time, s")
      ->check(between(0, 1e9))
      ->transform(in_seconds);
  v->add_option("-o,--out", o->out, "Signatures to write, CSV")->check(not_empty);
  v->add_option("--report", o->report, "Page to write, HTML, with all figures")->check(not_empty);
  v->add_option("--picture", o->picture,
                "One video: flow of the busiest pair before and after filtering, PNG")
      ->check(not_empty);
  v->add_flag("--force", o->force, "Replace existing files");
  add_flow_options(v, o->flow);
  v->callback([o, &line] { line.code = activity(*o, line.common); });
}

}  // namespace faba::cli
