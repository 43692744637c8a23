#include <fmt/format.h>

#include "cli/verbs.h"
#include "core/error.h"
#include "study/drop_report.h"

namespace faba::cli {

namespace {

void check_overlay(const DropVerb& v) {
  if (v.overlay.empty()) return;
  const auto refuse = [&](const char* why) { throw Error(Errc::usage, v.overlay.string(), why); };
  std::error_code ec;
  if (std::filesystem::equivalent(v.overlay, v.picture, ec))
    refuse("is the picture itself; choose another --overlay");
  if (std::filesystem::is_directory(v.overlay, ec)) refuse("is a directory; name a file such as edge.png");
  if (v.overlay.extension() != ".png") refuse("must end in .png, which is what is written");
  if (!v.force && std::filesystem::exists(std::filesystem::symlink_status(v.overlay, ec)))
    refuse("already exists; choose another --overlay, or --force to replace it");
}

}  // namespace

int drop(const DropVerb& v, const Common& c) {
  check_overlay(v);
  const auto j = report_drop(v.picture, v.overlay);
  if (c.json) {
    fmt::print("{}\n", j.dump());
  } else if (!c.quiet) {
    const auto number = [&](const char* a, const char* b) { return j[a][b].get<double>(); };
    fmt::print(
        "centre  ({:.1f} +- {:.1f}, {:.1f} +- {:.1f}) px\nradius  {:.1f} +- {:.1f} px\narc     {:.0f} "
        "degrees in view\n",
        j["center_px"][0].get<double>(), number("sd_px", "x"), j["center_px"][1].get<double>(),
        number("sd_px", "y"), j["radius_px"].get<double>(), number("sd_px", "radius"),
        j["arc_deg"].get<double>());
    if (!v.overlay.empty()) fmt::print("overlay {}\n", v.overlay.string());
    if (std::filesystem::exists("scenes/drop.toml"))
      fmt::print("now try: {} run scenes/drop.toml --from-video {}\n", shell_word(program()),
                 shell_word(v.picture.string()));
  }
  return 0;
}

}  // namespace faba::cli
