#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <nlohmann/json.hpp>

#include "cli/command_line.h"
#include "cli/output_file.h"
#include "cli/provenance.h"
#include "cli/quality_text.h"
#include "core/error.h"
#include "core/process/child.h"
#include "study/drop/drop_warnings.h"
#include "study/pages/drop_report.h"
#include "study/quality/rounded.h"

namespace faba::cli {
namespace {

struct DropVerb {
  std::filesystem::path picture, overlay, stages;
  bool force = false;
};

int drop(const DropVerb& v, const Common& c) {
  check_output(v.overlay, {".png"}, v.force, {v.picture});
  check_output_folder(v.stages, "--stages");
  if (!v.stages.empty() && std::filesystem::exists(v.stages))
    for (const char* stage : kDropStages) check_output(v.stages / stage, {".png"}, v.force, {v.picture});
  const DropEdge edge = report_drop(v.picture, v.overlay, v.stages);
  if (c.json) {
    print_json(drop_json(edge, scale_of_file(v.picture)), provenance_of(c, {v.picture}));
  } else if (!c.quiet) {
    fmt::print(
        "centre  ({}, {}) px\nradius  {} px\narc     {:.0f} degrees visible; +- is the standard error\n",
        with_uncertainty(edge.centre_image.x, edge.sd_centre_px.x),
        with_uncertainty(edge.centre_image.y, edge.sd_centre_px.y),
        with_uncertainty(edge.radius_px, edge.sd_radius_px), edge.arc_deg);
    print_quality(drop_warnings(edge), 8);
    if (!v.overlay.empty()) fmt::print("overlay {}\n", v.overlay.string());
    if (!v.stages.empty()) fmt::print("stages  {}\n", v.stages.string());
    if (std::filesystem::exists("scenes/drop.toml"))
      fmt::print("next: {} run scenes/drop.toml --from-video {}\n", shell_word(program()),
                 shell_word(v.picture.string()));
  }
  return 0;
}

}  // namespace

void add_drop(CLI::App& app, CommandLine& line) {
  const auto d = std::make_shared<DropVerb>();
  CLI::App* v =
      verb(app, line, "drop", "Detect the edge of a drop in a picture or in the first frame of a video",
           "  faba drop drop.tif --overlay edge.png\n  faba drop film.avi --json");
  v->add_option("picture", d->picture, "Picture (TIFF, PNG, JPEG or PGM, 8 or 16 bit) or video")->required();
  v->add_option("--overlay", d->overlay, "Write the picture with the detected edge, as PNG")
      ->check(not_empty);
  v->add_option("--stages", d->stages, "Write a picture of each stage of the search into this folder, as PNG")
      ->check(not_empty);
  v->add_flag("--force", d->force, "Replace existing pictures");
  v->callback([d, &line] { line.code = drop(*d, line.common); });
}

}  // namespace faba::cli
