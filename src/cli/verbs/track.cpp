#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <algorithm>

#include "app/scenario/calibration_file.h"
#include "cli/command_line.h"
#include "cli/output_file.h"
#include "cli/progress.h"
#include "core/counted.h"
#include "core/error.h"
#include "study/pages/track_report.h"

#include <nlohmann/json.hpp>

namespace faba::cli {
namespace {

struct TrackVerb {
  std::filesystem::path video, swarm, overlay, report, picture, figures;
  std::vector<std::filesystem::path> out;
  std::string scale;  ///< a number or a calibration file
  std::string polarity = "auto", background = "auto", motion = "auto";
  double fps = 0, size_px = 0, threshold = 0, reach_px = 0;
  int memory = 2, least = 3, interval = 0;
  bool drop = false, force = false;
};

template <class Enum>
Enum chosen(const std::string& word, const std::vector<const char*>& words) {
  return Enum(std::find(words.begin(), words.end(), word) - words.begin());
}

TrackOptions options_of(const TrackVerb& v) {
  TrackOptions o;
  o.video = v.video, o.fps = v.fps, o.out = v.out;
  if (!v.scale.empty()) o.um_per_px = parse_calibration(v.scale, "--um-per-px").um_per_px;
  o.swarm = v.swarm, o.overlay = v.overlay, o.report = v.report, o.picture = v.picture, o.figures = v.figures;
  o.size_px = v.size_px, o.threshold_sd = v.threshold, o.inside_drop = v.drop, o.interval_frames = v.interval;
  o.polarity = chosen<Polarity>(v.polarity, {"auto", "dark", "bright", "both"});
  o.background = chosen<BackgroundKind>(v.background, {"auto", "median", "spatial"});
  o.tracker.motion = chosen<Motion>(v.motion, {"auto", "nearest", "velocity"});
  o.tracker.reach_px = v.reach_px, o.tracker.memory = v.memory, o.tracker.least_points = v.least;
  return o;
}

void check_outputs(const TrackVerb& v) {
  for (const auto& path : v.out) {
    if (path.extension() != ".csv" && path.extension() != ".h5")
      throw Error(Errc::usage, path.string(), "must end in .csv or .h5, which is what is written");
    check_output(path, "", v.force, {v.video});
  }
  if (!v.overlay.empty() && v.overlay.extension() != ".mp4" && v.overlay.extension() != ".avi")
    throw Error(Errc::usage, v.overlay.string(), "must end in .mp4 or .avi, which is what is written");
  std::vector<std::filesystem::path> all = v.out;
  all.insert(all.end(), {v.swarm, v.overlay, v.report, v.picture});
  check_distinct(std::move(all));
  check_output(v.swarm, ".csv", v.force, {v.video});
  check_output(v.overlay, "", v.force, {v.video});
  check_output(v.report, ".html", v.force, {v.video});
  check_output(v.picture, ".png", v.force, {v.video});
  if (!v.figures.empty() && std::filesystem::exists(v.figures) && !std::filesystem::is_directory(v.figures))
    throw Error(Errc::usage, v.figures.string(), "is a file; --figures names a folder");
  if (!v.figures.empty() && std::filesystem::is_directory(v.figures))
    for (const char* name : {"tracks.svg", "speeds.svg", "msd.svg", "heading.svg"})
      check_output(v.figures / name, ".svg", v.force, {v.video});
}

// "12.3 +- 0.4 um/s", in um where there is a scale.
std::string value_words(const nlohmann::ordered_json& from, const std::string& name, const char* px,
                        const char* um, const char* px_words, const char* um_words) {
  const bool scaled = from.contains(name + "_" + um);
  const std::string key = name + "_" + (scaled ? um : px);
  if (from[key].is_null()) return "-";
  std::string words = fmt::format("{:.3g}", from[key].get<double>());
  if (!from[key + "_se"].is_null()) words += fmt::format(" +- {:.2g}", from[key + "_se"].get<double>());
  return words + " " + (scaled ? um_words : px_words);
}

void print_summary(const nlohmann::ordered_json& j) {
  const auto& d = j["detection"];
  fmt::print("spots    {:.4g} in a frame, {} and {:.2g} px wide, against the {} background\n",
             d["spots_per_frame"].get<double>(), d["polarity"].get<std::string>(), d["size_px"].get<double>(),
             d["background"].get<std::string>());
  fmt::print("tracks   {} in {}, {:.3g} places each\n", j["tracks"].get<std::uint64_t>(),
             counted(j["frames"].get<std::uint64_t>(), "frame"), j["mean_points"].get<double>());
  const auto above_half = [&](const char* order) {
    return j[order].is_number() && j[order].get<double>() > 0.5;
  };
  const bool drifts = above_half("order") && j["drift"].is_object();
  const bool together = drifts || above_half("order_at_a_time");
  const char* about = !together ? "" : drifts ? "about the drift " : "about the common motion ";
  const bool timed = j["timed"].get<bool>();
  const auto value_of = [&](const nlohmann::ordered_json& from, const std::string& name, const char* px,
                            const char* um, const char* px_words, const char* um_words) {
    std::string words = value_words(from, name, px, um, px_words, um_words);
    if (const auto at = words.rfind("/s"); !timed && at != std::string::npos) words.replace(at, 2, "/frame");
    if (!timed && words.ends_with(" s")) words.replace(words.size() - 1, 1, "frames");
    return words;
  };
  if (j["speed"].is_object() && (together || j["supported"] != "diffusion"))
    fmt::print("speed    {} on average, over {:.3g} {}\n",
               value_of(j["speed"], "mean", "px_s", "um_s", "px/s", "um/s"),
               j["speed"]["interval_s"].get<double>(), timed ? "s" : "frames");
  if (drifts)
    fmt::print("drift    {} right, {} down\n", value_of(j["drift"], "x", "px_s", "um_s", "px/s", "um/s"),
               value_of(j["drift"], "y", "px_s", "um_s", "px/s", "um/s"));
  if (j["supported"] == "diffusion" && j["diffusion"].is_object())
    fmt::print("motion   {}no direction is kept: diffusion, D = {}\n", about,
               value_of(j["diffusion"], "d", "px2_s", "um2_s", "px^2/s", "um^2/s"));
  if (j["supported"] == "persistent_walk" && j["persistent_walk"].is_object())
    fmt::print("motion   {}direction is kept: walk at {} (rms), for {}\n", about,
               value_of(j["persistent_walk"], "speed_rms", "px_s", "um_s", "px/s", "um/s"),
               j["persistent_walk"]["tau_longer_than_seen"].get<bool>()
                   ? "longer than was seen"
                   : value_of(j["persistent_walk"], "tau", "s", "-", "s", ""));
}

int track(const TrackVerb& v, const Common& c) {
  check_outputs(v);
  const auto& stop = stop_requested();
  Progress bar("tracking", !c.quiet);
  const auto j = track_video(options_of(v), [&](std::int64_t done, std::int64_t total) {
    bar.update(std::uint64_t(done), std::uint64_t(total));
    return !stop;
  });
  bar.clear();
  if (!c.quiet && !c.json)
    for (const auto& note : j["notes"]) tell("faba: note: " + note.get<std::string>());
  if (c.json) {
    fmt::print("{}\n", j.dump());
    return 0;
  }
  if (c.quiet) return 0;
  print_summary(j);
  for (const auto& path : v.out) fmt::print("written  {}\n", path.string());
  for (const auto* path : {&v.swarm, &v.overlay, &v.report, &v.picture, &v.figures})
    if (!path->empty()) fmt::print("written  {}\n", path->string());
  return 0;
}

}  // namespace

void add_track(CLI::App& app, CommandLine& line) {
  const auto t = std::make_shared<TrackVerb>();
  CLI::App* v =
      verb(app, line, "track", "Find and follow cells or beads in a video and measure how they move",
           "  faba track film.avi --um-per-px 0.35 --out tracks.csv --report tracks.html\n"
           "  faba track 'frames/frame_*.tif' --fps 26.87 --out tracks.h5 --overlay seen.mp4");
  v->add_option("video", t->video,
                "Video, TIFF stack, folder of pictures, pattern in quotes, or run directory")
      ->required();
  v->add_option("--fps", t->fps, "Frames per second, where the video does not state them or not truly")
      ->check(between(1e-6, 1e7));
  v->add_option("--um-per-px", t->scale,
                "Scale: micrometres per pixel, or a calibration file of `faba scale`")
      ->check(not_empty);
  v->add_option("--out", t->out, "Write the tracks, as CSV or HDF5 by the ending; may be given twice");
  v->add_option("--swarm", t->swarm, "Write centroid and spread of the swarm in each frame, as CSV");
  v->add_option("--overlay", t->overlay, "Write the video with the tracks drawn in, as MP4 or AVI");
  v->add_option("--report", t->report, "Write a page with figures and numbers, as HTML");
  v->add_option("--picture", t->picture, "Write the first frame with all tracks, as PNG");
  v->add_option("--figures", t->figures, "Write the figures into this folder, as SVG");
  v->add_option("--size", t->size_px, "Width of a cell at half its contrast, px; found when absent")
      ->check(between(1, 60));
  v->add_option("--polarity", t->polarity, "Cells are dark, bright or both; found when absent")
      ->check(CLI::IsMember({"auto", "dark", "bright", "both"}));
  v->add_option("--background", t->background, "median of the video, or spatial: each frame, smoothed")
      ->check(CLI::IsMember({"auto", "median", "spatial"}));
  v->add_option("--threshold", t->threshold,
                "Least signal-to-noise of a spot; 1 false one in 10 frames when absent")
      ->check(between(1, 1e6));
  v->add_option("--reach", t->reach_px, "Farthest displacement between two frames, px; found when absent")
      ->check(between(0.1, 1e5));
  v->add_option("--motion", t->motion, "Foretell by velocity or as nearest; found when absent")
      ->check(CLI::IsMember({"auto", "nearest", "velocity"}));
  v->add_option("--memory", t->memory, "Frames in a row that a cell may be unseen")
      ->check(CLI::Range(0, 1000));
  v->add_option("--least", t->least, "Shortest track that counts, in sightings")
      ->check(CLI::Range(1, 100000));
  v->add_option("--interval", t->interval,
                "Frames over which displacements are taken for speeds and turns; found when absent")
      ->check(CLI::Range(1, 100000));
  v->add_flag("--drop", t->drop, "Find the edge of the drop and look inside it only");
  v->add_flag("--force", t->force, "Replace existing files");
  v->callback([t, &line] { line.code = track(*t, line.common); });
}

}  // namespace faba::cli
