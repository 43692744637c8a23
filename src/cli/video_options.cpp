#include <CLI/CLI.hpp>

#include "cli/command_line.h"
#include "cli/verbs.h"

namespace faba::cli {

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
}

}  // namespace faba::cli
