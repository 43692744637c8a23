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
#include "core/error.h"
#include "core/threads/ordered_work.h"
#include "study/data/run_video.h"
#include "vision/files/tiff_export.h"

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

std::vector<std::string> notes_of(const RunVideo& source, const TiffExported& done, bool ome) {
  std::vector<std::string> notes;
  if (!source.scale.ignored.empty()) notes.push_back(source.scale.ignored);
  if (!source.scale.um_per_px)
    notes.emplace_back("the scale is not known, so the file states none; give it with --um-per-px");
  if (!done.frame_s)
    notes.emplace_back(
        "the frame rate is not known, so the file states no frame interval; give it with --fps");
  if (!done.regular)
    notes.emplace_back("the frames are not at equal times; the file states the mean frame interval");
  if (done.big && !ome)
    notes.emplace_back(
        "the file exceeds 4 GB and is a BigTIFF, which ImageJ reads with Bio-Formats; for a smaller file, "
        "select "
        "a part with --from and --to");
  if (!done.damage.empty()) notes.push_back("damaged frames are missing: " + done.damage);
  return notes;
}

int convert(const ConvertVerb& v, const Common& c) {
  check_output(v.out, {".tif", ".tiff"}, v.force, {v.video});
  RunVideo source = video_or_drawing(v.video);
  if (!v.scale.empty()) {
    const Calibration given = parse_calibration(v.scale, "--um-per-px");
    source.scale = {given.um_per_px, given.typed() ? "typed" : "calibration", ""};
  }
  const VideoPart part = v.part.part(v.fps);
  VideoReader video(source.file, part.fps, OrderedWork::threads(v.threads));
  Progress bar("converting", !c.quiet && !c.json);
  const auto& stop = stop_requested();
  const auto progress = [&](std::int64_t done, std::int64_t total) {
    bar.update(std::uint64_t(done), std::uint64_t(total));
    return !stop;
  };
  const TiffExported done =
      export_tiff(video, {v.out, source.scale.um_per_px, part.from_s, part.to_s, source.drawing, progress});
  bar.clear();
  const bool ome = tiff_kind(v.out) == TiffKind::ome;
  const std::vector<std::string> notes = notes_of(source, done, ome);
  if (c.json) {
    const auto or_null = [](const std::optional<double>& value) { return value ? Json(*value) : Json(); };
    print_json({{"out", v.out.string()},
                {"metadata", ome ? "ome" : "imagej"},
                {"frames", done.frames},
                {"image_size", {video.width(), video.height()}},
                {"bits", done.pixels == TiffPixels::grey16       ? 16
                         : done.pixels == TiffPixels::grey_float ? 32
                                                                 : 8},
                {"colour", done.pixels == TiffPixels::colour},
                {"um_per_px", or_null(source.scale.um_per_px)},
                {"um_per_px_source", source.scale.source.empty() ? Json() : Json(source.scale.source)},
                {"frame_s", or_null(done.frame_s)},
                {"big_tiff", done.big},
                {"notes", notes}},
               provenance_of(c, {v.video}));
    return 0;
  }
  if (c.quiet) return 0;
  for (const std::string& note : notes)
    print_stderr(fmt::format("faba: note: {}: {}", v.video.string(), note));
  fmt::print("wrote    {}: {}, {}{}{}\n", v.out.string(), counted(done.frames, "frame"), word_of(done.pixels),
             source.scale.um_per_px ? fmt::format(", {:.6g} um/px", *source.scale.um_per_px) : "",
             done.frame_s ? fmt::format(", every {:.6g} s", *done.frame_s) : "");
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
