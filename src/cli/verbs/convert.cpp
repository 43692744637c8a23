#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <nlohmann/json.hpp>

#include "app/scenario/calibration_file.h"
#include "cli/command_line.h"
#include "cli/options/video_part.h"
#include "cli/output_file.h"
#include "cli/progress.h"
#include "cli/provenance.h"
#include "core/counted.h"
#include "study/data/tiff_conversion.h"

namespace faba::cli {
namespace {

struct ConvertVerb {
  std::filesystem::path video, out;
  std::string scale;  ///< number or calibration file
  double fps = 0;
  PartOptions part;
  unsigned threads = 0;
  bool force = false;
};

const char* word_of(TiffPixels pixels) {
  return pixels == TiffPixels::grey8    ? "grey, 8 bits"
         : pixels == TiffPixels::grey16 ? "grey, 16 bits"
         : pixels == TiffPixels::colour ? "colours, 8 bits"
                                        : "grey, 32-bit floats";
}

void print_result(const ConvertedTiff& done, const ConvertVerb& v) {
  for (const std::string& note : done.notes)
    print_stderr(fmt::format("faba: note: {}: {}", v.video.string(), note));
  const TiffExported& stack = done.stack;
  fmt::print("wrote    {}: {}, {}{}{}\n", v.out.string(), counted(stack.frames, "frame"),
             word_of(stack.pixels),
             done.scale.um_per_px ? fmt::format(", {:.6g} um/px", *done.scale.um_per_px) : "",
             stack.frame_s ? fmt::format(", every {:.6g} s", *stack.frame_s) : "");
}

Json result_json(const ConvertedTiff& done, const ConvertVerb& v) {
  const auto or_null = [](const std::optional<double>& value) { return value ? Json(*value) : Json(); };
  const TiffPixels pixels = done.stack.pixels;
  return {{"out", v.out.string()},
          {"metadata", done.kind == TiffKind::ome ? "ome" : "imagej"},
          {"frames", done.stack.frames},
          {"image_size", {done.width, done.height}},
          {"bits", pixels == TiffPixels::grey16       ? 16
                   : pixels == TiffPixels::grey_float ? 32
                                                      : 8},
          {"colour", pixels == TiffPixels::colour},
          {"um_per_px", or_null(done.scale.um_per_px)},
          {"um_per_px_source", done.scale.source.empty() ? Json() : Json(done.scale.source)},
          {"frame_s", or_null(done.stack.frame_s)},
          {"big_tiff", done.stack.big},
          {"notes", done.notes}};
}

int convert(const ConvertVerb& v, const Common& c) {
  check_output(v.out, {".tif", ".tiff"}, v.force, {v.video});
  TiffConversion job{v.video, v.out, {}, v.part.part(v.fps), v.threads, {}};
  if (!v.scale.empty()) {
    const Calibration given = parse_calibration(v.scale, "--um-per-px");
    job.scale = {given.um_per_px, given.typed() ? "typed" : "calibration", ""};
  }
  Progress bar("converting", !c.quiet && !c.json);
  const auto& stop = stop_requested();
  job.progress = [&](std::int64_t done, std::int64_t total) {
    bar.update(std::uint64_t(done), std::uint64_t(total));
    return !stop;
  };
  const ConvertedTiff done = convert_to_tiff(job);
  bar.clear();
  if (c.json)
    print_json(result_json(done, v), provenance_of(c, {v.video}));
  else if (!c.quiet)
    print_result(done, v);
  return 0;
}

}  // namespace

void add_convert(CLI::App& app, CommandLine& line) {
  const auto o = std::make_shared<ConvertVerb>();
  CLI::App* v = verb(app, line, "convert",
                     "Convert a video or the video of a run to a TIFF stack with scale and frame interval",
                     "  faba convert film.avi film.ome.tif --um-per-px 0.35\n"
                     "  faba convert runs/steer-1 steer.tif --from \"2 s\" --to \"4 s\"\n"
                     "  faba convert pictures film.ome.tif --fps 26.87 --um-per-px scale.toml");
  v->add_option("video", o->video,
                "Video, TIFF stack, folder of pictures, quoted file name pattern, or run directory")
      ->required();
  v->add_option("out", o->out, "File to write: NAME.ome.tif has OME metadata, NAME.tif those of ImageJ")
      ->required();
  v->add_option(
       "--um-per-px", o->scale,
       "Scale: micrometres per pixel, or a calibration file from `faba scale`; default: that of a run "
       "directory or in the metadata of the file")
      ->check(not_empty);
  v->add_option("--fps", o->fps,
                "Frames per second, if the video states none or a wrong value; default: that of the video")
      ->check(between(1e-6, 1e7));
  add_part_options(v, o->part);
  add_threads_option(v, o->threads);
  v->add_flag("--force", o->force, "Replace an existing file");
  v->callback([o, &line] { line.code = convert(*o, line.common); });
}

}  // namespace faba::cli
