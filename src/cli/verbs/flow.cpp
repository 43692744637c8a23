#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <nlohmann/json.hpp>

#include "cli/command_line.h"
#include "cli/options/flow.h"
#include "cli/output_file.h"
#include "cli/progress.h"
#include "cli/provenance.h"
#include "cli/quality_text.h"
#include "core/counted.h"
#include "core/error.h"
#include "study/motion/histogram_files.h"
#include "study/pages/flow_report.h"

namespace faba::cli {
namespace {

struct FlowVerb {
  std::filesystem::path a, b, out, picture, truth, overlay;
  FlowOptions flow;
  bool force = false;
};

void print_notes(const std::vector<std::string>& notes, const std::filesystem::path& file, const Common& c) {
  if (c.quiet) return;
  for (const std::string& note : notes) print_stderr(fmt::format("faba: note: {}: {}", file.string(), note));
}

void check_extension(const std::filesystem::path& out, const char* extension, const char* advice) {
  if (!out.empty() && out.extension() != extension)
    throw Error(Errc::usage, out.string(),
                fmt::format("the file extension must be {}; {}", extension, advice));
}

FlowJob job_of(const FlowVerb& v) {
  FlowJob job;
  job.method = flow_part({v.flow.method, v.flow.values});
  job.out = v.out;
  job.picture = v.picture;
  job.truth = v.truth;
  job.overlay = v.overlay;
  job.shrink = v.flow.shrink;
  job.fps = v.flow.fps;
  const VideoPart part = v.flow.part.part();
  job.from_s = part.from_s;
  job.to_s = part.to_s;
  job.options_text = options_text({v.flow.method, v.flow.values}, v.flow.shrink, v.flow.fps);
  job.threads = v.flow.threads;
  return job;
}

int flow_pair(const FlowVerb& v, const Common& c) {
  check_extension(v.out, ".flo", "the flow of two pictures is written as .flo (.h5 is for a video)");
  check_output(v.out, {".flo"}, v.force, {v.a, v.b, v.truth});
  check_output(v.picture, {".png"}, v.force, {v.a, v.b, v.truth});
  if (!v.overlay.empty())
    throw Error(Errc::usage, "--overlay", "requires a video; for two pictures use --picture");
  for (const auto& [option, given] :
       {std::pair{"--shrink", v.flow.shrink > 1}, std::pair{"--fps", v.flow.fps > 0},
        std::pair{"--from", v.flow.part.from.has_value()}, std::pair{"--to", v.flow.part.to.has_value()}})
    if (given) throw Error(Errc::usage, option, "requires a video, but two pictures are given");
  const PairFlow flow = flow_of_pair(v.a, v.b, job_of(v));
  if (c.json) {
    print_json(flow_json(flow), provenance_of(c, {v.a, v.b, v.truth}));
    return 0;
  }
  print_notes(flow.notes, v.a, c);
  if (c.quiet) return 0;
  fmt::print("flow     mean ({:.4g}, {:.4g}) px, mean speed {:.4g} px, maximum {:.4g} px\n", flow.mean_px.x,
             flow.mean_px.y, flow.mean_speed_px, flow.largest_px);
  if (flow.effort)
    fmt::print("solver   {}, {}\n", counted(std::uint64_t(flow.effort->iterations), "iteration"),
               flow.effort->converged ? "converged" : "not converged");
  if (flow.error)
    fmt::print(
        "truth    endpoint error {:.4f} px, angular error {:.3f} degrees, over {:.1f} % of the pixels\n",
        flow.error->endpoint_px, flow.error->angular_deg, 100 * flow.error->known);
  print_quality(flow.warnings);
  for (const auto& file : {v.out, v.picture})
    if (!file.empty()) fmt::print("wrote    {}\n", file.string());
  return 0;
}

int flow_video(const FlowVerb& v, const Common& c) {
  check_extension(v.out, ".h5", "the flow of a video is written as .h5 (.flo holds one pair only)");
  check_output(v.out, {".h5"}, v.force, {v.a});
  check_output(v.overlay, {".mp4"}, v.force, {v.a});
  for (const auto& [option, file] : {std::pair{"--picture", v.picture}, std::pair{"--truth", v.truth}})
    if (!file.empty()) throw Error(Errc::usage, option, "requires two pictures, but one video is given");
  Progress bar("flow", !c.quiet && !c.json);
  FlowJob job = job_of(v);
  job.progress = [&](std::uint64_t done, std::uint64_t total) { bar.update(done, total); };
  job.stop = [&stop = stop_requested()] { return stop.load(); };
  const VideoFlow flow = flow_of_video(v.a, job);
  bar.clear();
  if (c.json) {
    print_json(flow_json(flow), provenance_of(c, {v.a}));
    return 0;
  }
  print_notes(flow.notes, v.a, c);
  if (c.quiet) return 0;
  const std::string duration = flow.timed ? fmt::format("of frames in {:.3g} s", flow.seconds)
                                          : fmt::format("in {:.6g} frames", flow.seconds + 1);
  fmt::print("{} {}, {} x {} px, mean speed {:.4g} px per pair\n", counted(flow.pairs, "pair"), duration,
             flow.width, flow.height, flow.mean_speed_px);
  print_quality(flow.warnings);
  for (const auto& file : {v.out, v.overlay})
    if (!file.empty()) fmt::print("wrote {}\n", file.string());
  return 0;
}

int flow(const FlowVerb& v, const Common& c) { return v.b.empty() ? flow_video(v, c) : flow_pair(v, c); }

}  // namespace

void add_flow(CLI::App& app, CommandLine& line) {
  const auto o = std::make_shared<FlowVerb>();
  CLI::App* v = verb(
      app, line, "flow", "Compute the optical flow between two pictures, or from frame to frame of a video",
      "  faba flow a.png b.png --out ab.flo --picture ab.png\n"
      "  faba flow a.png b.png --pyramid --truth true.flo\n"
      "  faba flow film.mp4 --solver jacobi --iterations 100 --out film.h5 --overlay arrows.mp4");
  v->add_option("a", o->a, "First picture; or a video, a folder of pictures, or a run directory")->required();
  v->add_option("b", o->b, "Second picture");
  v->add_option("-o,--out", o->out, "File to write: .flo (Middlebury) for two pictures, .h5 for a video")
      ->check(not_empty);
  v->add_option("--picture", o->picture, "Two pictures: write the flow in colours, as PNG")->check(not_empty);
  v->add_option("--truth", o->truth, "Two pictures: the true flow (.flo), to print the error")
      ->check(not_empty);
  v->add_option("--overlay", o->overlay, "Video: write its frames with the flow as arrows, as MP4")
      ->check(not_empty);
  v->add_flag("--force", o->force, "Replace existing files");
  add_flow_options(v, o->flow);
  v->callback([o, &line] { line.code = flow(*o, line.common); });
}

}  // namespace faba::cli
