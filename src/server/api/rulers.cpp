#include "server/api/rulers.h"

#include <fmt/format.h>

#include <atomic>

#include "core/error.h"
#include "core/file.h"
#include "server/files/opened_input.h"
#include "study/pages/scale_report.h"

namespace faba {
namespace {

namespace fs = std::filesystem;

// report_scale_picture() without the name of the temporary file in its errors.
PictureScale scale_of_taken(const fs::path& taken, double tick_m, const fs::path& shown) {
  try {
    return report_scale_picture(taken, tick_m, shown);
  } catch (const Error& e) {
    throw Error(e.code(), "", e.reason());
  }
}

}  // namespace

Json measure_ruler(const LabServices& lab, const fs::path& picture, double tick_um, const std::string& name,
                   const std::string& extension) {
  static std::atomic<unsigned> number{0};
  if (!(tick_um >= 1e-3 && tick_um <= 1e6))
    throw Error(
        Errc::usage, "tick_um",
        fmt::format("{:g} is out of range; the distance between marks must be between 0.001 and 1e6 um",
                    tick_um));
  const fs::path kept = lab.workspace.inside(name + extension), file = lab.workspace.inside(name + ".toml");
  const std::string shown = fmt::format("ruler-{}.png", ++number);
  const PictureScale scale = scale_of_taken(picture, 1e-6 * tick_um, lab.pictures / shown);
  Json j = scale_json(scale);
  j["url"] = "/api/uploads/" + shown;
  if (quality_of(scale.warnings) == Quality::poor) return j;  // displayed, but not saved
  fs::create_directories(kept.parent_path());
  Calibration c = calibration_of(scale);
  c.source = kept.filename().string();
  with_opened(kept.parent_path(), name, [&](const fs::path& folder) {
    write_file(folder / kept.filename(), read_file(picture));
    write_calibration(folder / file.filename(), c);
  });
  j["file"] = name + ".toml";
  return j;
}

}  // namespace faba
