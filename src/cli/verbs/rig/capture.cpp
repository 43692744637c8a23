#include <fmt/format.h>

#include <CLI/CLI.hpp>

#include "app/bench/capture.h"
#include "app/bench/open_bench.h"
#include "cli/command_line.h"
#include "cli/options/bench.h"
#include "cli/progress.h"
#include "cli/quantity.h"
#include "core/error.h"

namespace faba::cli {
namespace {

struct CaptureVerb {
  SceneOptions run;
  std::optional<std::string> every, time;
  std::string format;
  std::uint64_t frames = 0, one_of = 1;
  bool buffered = false;
};

int rig_capture(const CaptureVerb& v, const Common& c) {
  Scenario s = read_bench_scene(v.run);
  CaptureJob job;
  job.out = v.run.out;
  job.force = v.run.force;
  job.frames = v.frames;
  job.one_of = v.one_of;
  job.buffered = v.buffered;
  const auto span = [](const std::string& words, const char* option) {
    const double value = quantity_of(words, "s", option, "500 ms");
    if (!(value > 0)) throw Error(Errc::usage, option, "must be above zero");
    return value;
  };
  if (v.time) job.time = span(*v.time, "--for");
  if (v.every) job.every = span(*v.every, "--every");
  const std::string ending = job.out.extension().string();
  job.format = !v.format.empty() ? v.format : ending == ".mp4" ? "mp4" : ending == ".avi" ? "avi" : "png";
  if (!v.format.empty() && (ending == ".mp4" || ending == ".avi"))
    throw Error(Errc::usage, "--format", "is for pictures, and --out names a video");
  if (v.format.empty() && job.format == "png" && !ending.empty())
    throw Error(Errc::usage, job.out.string(),
                "end it in .avi or .mp4 for a video, or say --format for a folder of pictures");
  job.patience = s.rig ? s.rig->params.camera_timeout : job.patience;
  job.stop = &stop_requested();
  Progress bar("capturing", !c.quiet && !c.json);
  job.progress = [&](std::uint64_t done, std::uint64_t total) { bar.update(done, total); };
  const OpenBench bench(s, s.params.seed.value_or(1));
  const Captured done = capture(bench.camera(), job);
  bar.clear();
  if (c.json)
    fmt::print("{}\n", Json{{"out", job.out.string()},
                            {"frames", done.taken},
                            {"kept", done.kept},
                            {"frames_dropped", done.dropped},
                            {"frames_corrupt", done.corrupt},
                            {"duration_s", done.duration},
                            {"memory_full", done.memory_full}}
                           .dump());
  else if (!c.quiet)
    fmt::print("{}: {} of {} frames in {:.2f} s, {} dropped, {} corrupt{}\n", job.out.string(), done.kept,
               done.taken, done.duration, done.dropped, done.corrupt,
               done.memory_full ? "; ended because memory went short" : "");
  // With an end of its own it was broken off; else that is how it ends.
  const bool cut = stop_requested().load() && (job.frames > 0 || job.time > 0 || done.kept == 0);
  return cut ? int(Errc::interrupted) : 0;
}

}  // namespace

void add_rig_capture(CLI::App& rig, CommandLine& line) {
  const auto o = std::make_shared<CaptureVerb>();
  CLI::App* v =
      verb(rig, line, "capture", "Record the camera alone: a video or numbered pictures, all frames or some",
           "  faba rig capture scenes/bench.toml --for \"10 s\" --out look.avi\n"
           "  faba rig capture scenes/bench.toml --frames 600 --one-of 10 --format pgm --out pictures\n"
           "  faba rig capture scenes/bench.toml --every \"500 ms\" --out lapse.mp4      until Ctrl-C");
  add_bench_scene(v, o->run);
  v->add_option("-o,--out", o->run.out, "Video (.avi without loss, .mp4), or folder of pictures")
      ->required()
      ->check(not_empty);
  v->add_option("--format", o->format, "Of numbered pictures in a folder")
      ->check(CLI::IsMember({"png", "pgm", "ppm", "tiff"}));
  v->add_option("--frames", o->frames, "End after as many frames of the camera, or --for if that is sooner")
      ->check(CLI::Range(std::uint64_t(1), std::uint64_t(1) << 40));
  v->add_option("--for", o->time, "End after as long, such as \"10 s\"; until Ctrl-C without an end");
  CLI::Option* one_of =
      v->add_option("--one-of", o->one_of, "Keep one of as many frames")->check(CLI::Range(1, 1000000));
  v->add_option("--every", o->every, "Keep one frame every so long, such as \"500 ms\"")->excludes(one_of);
  v->add_flag("--buffered", o->buffered,
              "Keep pictures in memory and write them afterwards: for disks that are too slow");
  v->add_flag("--force", o->run.force, "Replace a video");
  v->callback([o, &line] { line.code = rig_capture(*o, line.common); });
}

}  // namespace faba::cli
