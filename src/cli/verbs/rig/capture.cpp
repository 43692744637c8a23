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
  bool buffered = false, only_corrupt = false;
};

int rig_capture(const CaptureVerb& v, const Common& c) {
  Scenario s = read_bench_scene(v.run);
  CaptureJob job;
  job.out = v.run.out;
  job.force = v.run.force;
  job.frames = v.frames;
  job.one_of = v.one_of;
  job.buffered = v.buffered;
  job.only_corrupt = v.only_corrupt;
  const auto time_option = [](const std::string& text, const char* option) {
    const double value = quantity_of(text, "s", option, "500 ms");
    if (!(value > 0))
      throw Error(Errc::usage, option, fmt::format("{:g} s is out of range; it must be positive", value));
    return value;
  };
  if (v.time) job.time = time_option(*v.time, "--for");
  if (v.every) job.every = time_option(*v.every, "--every");
  job.um_per_px = s.scale.um_per_px;
  const std::string extension = job.out.extension().string(), video = capture_format(job.out);
  job.format = !v.format.empty() ? v.format : !video.empty() ? video : "png";
  if (!v.format.empty() && !video.empty())
    throw Error(Errc::usage, "--format", "is for pictures in a folder, but --out is a video or TIFF stack");
  if (v.format.empty() && video.empty() && !extension.empty())
    throw Error(Errc::usage, job.out.string(),
                "unknown file extension; use .avi or .mp4 for a video, .ome.tif or .tif for a TIFF stack, or "
                "give --format for a folder of pictures");
  job.timeout = s.rig ? s.rig->params.camera_timeout : job.timeout;
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
               done.memory_full ? "; stopped because the memory was full" : "");
  // Without --frames and --for, Ctrl-C is the regular end.
  const bool interrupted = stop_requested().load() && (job.frames > 0 || job.time > 0 || done.kept == 0);
  return interrupted ? int(Errc::interrupted) : 0;
}

}  // namespace

void add_rig_capture(CLI::App& rig, CommandLine& line) {
  const auto o = std::make_shared<CaptureVerb>();
  CLI::App* v = verb(
      rig, line, "capture",
      "Record the camera without the coils: a video, TIFF stack or numbered pictures, all frames or some",
      "  faba rig capture scenes/bench.toml --for \"10 s\" --out look.avi\n"
      "  faba rig capture scenes/bench.toml --for \"10 s\" --out look.ome.tif\n"
      "  faba rig capture scenes/bench.toml --frames 600 --one-of 10 --format pgm --out pictures\n"
      "  faba rig capture scenes/bench.toml --every \"500 ms\" --out lapse.mp4\n"
      "    (records until Ctrl-C)");
  add_bench_scene(v, o->run);
  v->add_option(
       "-o,--out", o->run.out,
       "Video (.avi lossless, or .mp4), TIFF stack (.ome.tif, or .tif for ImageJ), or folder of pictures")
      ->required()
      ->check(not_empty)
      ->type_name("FILE");
  v->add_option("--format", o->format, "Format of numbered pictures in a folder; default: png")
      ->check(one_of({"png", "pgm", "ppm", "tiff"}));
  v->add_option(
       "--frames", o->frames,
       "Stop after this number of camera frames, or after --for if that is earlier; default: on Ctrl-C")
      ->check(integers(1, std::int64_t(1) << 40));
  v->add_option("--for", o->time, "Stop after this time, such as \"10 s\"; default: on Ctrl-C");
  CLI::Option* one_of =
      v->add_option("--one-of", o->one_of, fmt::format("Keep one of N frames; default: {}", o->one_of))
          ->check(integers(1, 1000000));
  v->add_option("--every", o->every,
                "Keep one frame per time interval, such as \"500 ms\"; default: frames as by --one-of")
      ->excludes(one_of);
  v->add_flag("--buffered", o->buffered, "Keep pictures in memory and write them at the end, for slow disks");
  v->add_flag("--only-corrupt", o->only_corrupt,
              "Keep only frames that arrived damaged, to examine a camera or its cable");
  v->add_flag("--force", o->run.force, "Replace an existing video or stack");
  v->callback([o, &line] { line.code = rig_capture(*o, line.common); });
}

}  // namespace faba::cli
