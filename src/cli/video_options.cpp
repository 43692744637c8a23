#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <algorithm>

#include "app/scenario/parts.h"
#include "cli/command_line.h"
#include "cli/verbs.h"
#include "core/units.h"

namespace faba::cli {
namespace {

// For options that are seconds: "1.2 s" and "300 ms" as the number that they are; other words stay.
std::string in_seconds(std::string word) {
  try {
    const Quantity q = parse_quantity(word);
    return q.dimension == parse_unit("s").dimension ? fmt::format("{}", q.value) : word;
  } catch (const std::invalid_argument&) {
    return word;
  }
}

/// --shrink, --threads, --method, and an option for every parameter of every flow part, as their schemas
/// describe them.
void add_flow_options(CLI::App* v, FlowOptions& o) {
  v->add_option("--shrink", o.shrink,
                "Videos: average frames over squares of so many px first; unless given, until no side is "
                "above 1024 px")
      ->check(CLI::Range(1, 64));
  v->add_option("--fps", o.fps, "Videos: frames per second, where they do not state them or not truly")
      ->check(between(1e-6, 1e7));
  v->add_option("--threads", o.threads, "Threads; all of the machine's when absent. Never changes the result")
      ->check(CLI::Range(1, 1024));
  const Parts parts = builtin_parts();
  v->add_option("--method", o.method, "Flow part: " + fmt::format("{}", fmt::join(parts.flow.names(), ", ")))
      ->check(CLI::IsMember(parts.flow.names()))
      ->group("Flow");
  std::vector<std::string> names = parts.flow.names();
  std::partition(names.begin(), names.end(), [&](const std::string& n) { return n == o.method; });
  for (const std::string& name : names)
    for (const auto& [key, property] : parts.flow.json_schema(name)["properties"].items()) {
      std::string words = property["description"].get<std::string>() + " (" + name;
      if (property.contains("default")) words += ", " + property["default"].dump();
      const std::string option = "--" + key;
      if (v->get_option_no_throw(option)) continue;
      CLI::Option* added =
          property["type"] == "boolean"
              ? v->add_flag_callback(
                    option, [&o, k = key] { o.values.emplace_back(k, "true"); }, words + ")")
              : v->add_option_function<std::string>(
                    option, [&o, k = key](const std::string& text) { o.values.emplace_back(k, text); },
                    words + ")");
      added->group("Flow");
    }
}

void add_response_options(CLI::App* v, ResponseOptions& o) {
  v->add_option("--direction", o.direction,
                "Direction of the response in degrees: 0 right, 90 down; found when absent")
      ->check(between(-360, 360));
  v->add_option("--flow-threshold", o.flow_threshold,
                "Flows of less are noise, px per pair; found when absent")
      ->check(between(0, 1e9));
}

void add_flow(CLI::App& app, CommandLine& line) {
  const auto o = std::make_shared<FlowVerb>();
  CLI::App* v =
      verb(app, line, "flow", "Optical flow between two pictures, or from frame to frame of a video",
           "  faba flow a.png b.png --out ab.flo --picture ab.png\n"
           "  faba flow a.png b.png --pyramid --truth true.flo\n"
           "  faba flow film.mp4 --solver jacobi --iterations 100 --out film.h5 --overlay arrows.mp4");
  v->add_option("a", o->a, "First picture; or a video, a folder of frames, a run directory")->required();
  v->add_option("b", o->b, "Second picture");
  v->add_option("-o,--out", o->out, "File to write: .flo (Middlebury) for two pictures, .h5 for a video")
      ->check(not_empty);
  v->add_option("--picture", o->picture, "Two pictures: the flow in colours, PNG")->check(not_empty);
  v->add_option("--truth", o->truth, "Two pictures: the true flow (.flo), to say how far off this one is")
      ->check(not_empty);
  v->add_option("--overlay", o->overlay, "Video: arrows on its frames, MP4")->check(not_empty);
  v->add_flag("--force", o->force, "Replace existing files");
  add_flow_options(v, o->flow);
  v->callback([o, &line] { line.code = flow(*o, line.common); });
}

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

void add_compare(CLI::App& app, CommandLine& line) {
  const auto o = std::make_shared<CompareVerb>();
  CLI::App* v =
      verb(app, line, "compare",
           "How far the motion in videos or runs is from that in a reference, frame by frame",
           "  faba compare experiment.mp4 runs/basic-1 runs/basic-2 --report compare.html\n"
           "  faba compare experiment.mp4 simulation.avi --direction 0 --reference-t0 1.2 --t0 0.5");
  v->add_option("reference", o->reference, "Video, run directory or file of flows")->required();
  v->add_option("runs", o->runs, "Videos, run directories or files of flows to compare with it")->required();
  add_response_options(v, o->response);
  v->add_option("--reference-t0", o->reference_t0,
                "First moment after the reversal in the reference, s; found when absent")
      ->check(between(0, 1e9))
      ->transform(in_seconds);
  v->add_option("--t0", o->t0, "The same in the runs")->check(between(0, 1e9))->transform(in_seconds);
  v->add_flag("--no-align", o->no_align, "Compare from the first frames on")
      ->excludes("--t0")
      ->excludes("--reference-t0");
  v->add_option("--duration", o->duration, "Compare so many seconds from there on")
      ->check(between(1e-9, 1e9))
      ->transform(in_seconds);
  v->add_option("--m", o->m, "Exponent of the distance's normalisation, 0 or more and below 1");
  v->add_option("--threshold", o->threshold,
                "Columns or rows as far apart as this have nothing in common, px");
  v->add_flag("--no-floor", o->no_floor, "Do not run a scenario again to find the noise floor");
  v->add_option("-o,--out", o->out, "Distances to write, CSV")->check(not_empty);
  v->add_option("--report", o->report, "Page to write, HTML, with all figures")->check(not_empty);
  v->add_flag("--force", o->force, "Replace existing files");
  add_flow_options(v, o->flow);
  v->callback([o, &line] { line.code = compare(*o, line.common); });
}

void add_distance(CLI::App& app, CommandLine& line) {
  const auto o = std::make_shared<DistanceVerb>();
  CLI::App* v =
      verb(app, line, "distance", "Quadratic-Chi distance of histograms, one number per line in each file",
           "  faba distance p.csv q.csv\n  faba distance p.csv q1.csv q2.csv --m 0.5 --threshold 20");
  v->add_option("p", o->p, "Histogram")->required();
  v->add_option("q", o->q, "Histograms to compare it with; a line of output for each")->required();
  v->add_option("--m", o->m, "Exponent of the normalisation, 0 or more and below 1");
  v->add_option("--threshold", o->threshold, "Bins that are as far apart as this have nothing in common");
  v->add_option("--similarity", o->similarity, "Similarity of the bins instead: a CSV matrix")
      ->check(not_empty)
      ->excludes("--threshold");
  v->add_flag("--normalise", o->normalise, "Compare shapes only: both histograms to a sum of 1 first");
  v->callback([o, &line] { line.code = distance(*o, line.common); });
}

void add_scale(CLI::App& app, CommandLine& line) {
  const auto s = std::make_shared<ScaleVerb>();
  CLI::App* v = verb(app, line, "scale", "Micrometres per pixel, from a table or a picture of a ruler",
                     "  faba scale readings.csv --out calibration.toml\n"
                     "  faba scale ruler.png --tick \"10 um\" --overlay marks.png");
  v->add_option("ruler", s->ruler, "Readings as CSV (width_um,px_1,px_2), or a picture of a ruler")
      ->required();
  v->add_option("--tick", s->tick, "Distance between neighbouring finest marks of a ruler in a picture")
      ->check(not_empty);
  v->add_option("--out", s->out, "Write a calibration file, which scenarios and analyses take in, as TOML")
      ->check(not_empty);
  v->add_option("--overlay", s->overlay, "Write the picture with the marks drawn in, as PNG")
      ->check(not_empty);
  v->add_flag("--force", s->force, "Replace existing files");
  v->callback([s, &line] { line.code = scale(*s, line.common); });
}

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

}  // namespace

void add_video_verbs(CLI::App& app, CommandLine& line) {
  const auto d = std::make_shared<DropVerb>();
  CLI::App* v =
      verb(app, line, "drop", "Find the edge of a drop in a picture or in the first frame of a video",
           "  faba drop drop.tif --overlay edge.png\n  faba drop film.avi --json");
  v->add_option("picture", d->picture, "TIFF, PNG, JPEG, PGM (8 or 16 bit) or any video")->required();
  v->add_option("--overlay", d->overlay, "Write the picture with the edge drawn in, as PNG")
      ->check(not_empty);
  v->add_option("--stages", d->stages, "Write a picture of each stage of the search into this folder, as PNG")
      ->check(not_empty);
  v->add_flag("--force", d->force, "Replace existing pictures");
  v->callback([d, &line] { line.code = drop(*d, line.common); });
  add_track(app, line);
  add_flow(app, line);
  add_activity(app, line);
  add_compare(app, line);
  add_distance(app, line);
  add_scale(app, line);
}

}  // namespace faba::cli
