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
  job.said = options_said(choice, v.flow.shrink, v.flow.fps), job.frames = !v.picture.empty();
  job.noise = v.noise, job.shrink = v.flow.shrink, job.fps = v.flow.fps, job.threads = v.flow.threads;
  if (v.videos.size() == 1 && v.videos.front().extension() == ".toml") {
    read_activity_study(v.videos.front(), job);
    if (!choice.values.empty()) job.method = flow_part(choice, published_flow());
    if (!v.noise.empty()) job.noise = v.noise, job.threshold_px.reset();
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

std::string line_words(const nlohmann::ordered_json& line) {
  const auto slope = line["slope"].get<double>();
  return fmt::format("{:.4g} {} {:.4g} x exposure", line["intercept"].get<double>(), slope < 0 ? '-' : '+',
                     std::fabs(slope));
}

void summary(const nlohmann::ordered_json& j) {
  for (const auto& a : j["videos"]) {
    fmt::print("{}\n  mean activity {:.4g} px x px^2 per pair above {:.3g} px, direction {} degrees{}\n",
               a["video"].get<std::string>(), a["mean_activity"].get<double>(),
               a["threshold_px"].get<double>(), whole_degrees(a["direction_deg"].get<double>()),
               a["signal_to_noise"].is_null()
                   ? ""
                   : fmt::format(", signal to noise {:.3g}", a["signal_to_noise"].get<double>()));
    if (!a["mean_activity_per_cell"].is_null())
      fmt::print("  {:.3g} per visible cell, of which there are {:.3g}\n",
                 a["mean_activity_per_cell"].get<double>(), a["visible_cells"].get<double>());
    if (a["gaussian"]["good"].get<bool>())
      fmt::print("  maximum at {:.3g} +- {:.2g} s, width {:.3g} s\n", a["gaussian"]["peak_s"].get<double>(),
                 a["gaussian"]["se_peak_s"].get<double>(), a["gaussian"]["sigma_s"].get<double>());
    else
      fmt::print("  no Gaussian: {}\n", a["gaussian"]["why"].get<std::string>());
    for (const auto& s : a["segments"])
      fmt::print("  {:7.2f} to {:7.2f} s  towards {:3} degrees\n", s["t0_s"].get<double>(),
                 s["t1_s"].get<double>(), whole_degrees(s["direction_deg"].get<double>()));
    if (a["segments"].empty()) fmt::print("  at no time half of all that moves goes one way\n");
  }
  for (const auto& [name, words] :
       {std::pair{"peak_line", "time of the maximum"}, std::pair{"mean_line", "mean activity"},
        std::pair{"per_cell_line", "mean activity per visible cell"}})
    if (!j[name].is_null()) {
      fmt::print("{} = {}; 95 % of the slope {:.4g} to {:.4g}\n", words, line_words(j[name]),
                 j[name]["ci95"][0].get<double>(), j[name]["ci95"][1].get<double>());
      if (j[name].contains("frames"))
        fmt::print("  in frames, at {:.3g} per second: {}\n", j[name]["frames"]["rate_hz"].get<double>(),
                   line_words(j[name]["frames"]));
    }
  if (!j["cutoff_s"].is_null())
    fmt::print("cut-off at {:.4g} s in air; videos that do not fit it: {}\n", j["cutoff_s"].get<double>(),
               j["cutoff_wrong"].get<int>());
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
  const auto j = activity_json(result);
  if (c.json) {
    fmt::print("{}\n", j.dump());
    return 0;
  }
  if (c.quiet) return 0;
  for (const auto& a : j["videos"])
    for (const auto& note : a["notes"])
      tell(fmt::format("faba: note: {}: {}", a["video"].get<std::string>(), note.get<std::string>()));
  summary(j);
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
