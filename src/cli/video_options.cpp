#include <CLI/CLI.hpp>

#include "cli/command_line.h"
#include "cli/verbs.h"

namespace faba::cli {
namespace {

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

}  // namespace

void add_video_verbs(CLI::App& app, CommandLine& line) {
  const auto d = std::make_shared<DropVerb>();
  CLI::App* v =
      verb(app, line, "drop", "Find the edge of a drop in a picture or in the first frame of a video",
           "  faba drop drop.tif --overlay edge.png\n  faba drop film.avi --json");
  v->add_option("picture", d->picture, "TIFF, PNG, JPEG, PGM (8 or 16 bit) or any video")->required();
  v->add_option("--overlay", d->overlay, "Write the picture with the edge drawn in, as PNG")
      ->check(not_empty);
  v->add_flag("--force", d->force, "Replace an existing overlay");
  v->callback([d, &line] { line.code = drop(*d, line.common); });
  add_scale(app, line);
}

}  // namespace faba::cli
