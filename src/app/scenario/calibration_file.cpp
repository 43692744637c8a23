#include "app/scenario/calibration_file.h"

#include <fmt/format.h>

#include <cmath>
#include <stdexcept>

#include "core/file.h"
#include "core/units.h"

namespace faba {
namespace {

constexpr double kMinScale = 1e-3, kMaxScale = 1e3;  // um/px, as in a scenario

}  // namespace

Schema<Calibration> Calibration::schema() {
  return Schema<Calibration>("calibration", "The scale of a camera, written by faba scale")
      .add("um_per_px", &Calibration::um_per_px, {.min = 0, .max = kMaxScale, .doc = "Micrometres per pixel"})
      .add("ci95", &Calibration::ci95, {.doc = "Limits of its 95 % interval, um/px"})
      .add("method", &Calibration::method, {.doc = "Method of measurement"})
      .add("source", &Calibration::source, {.doc = "File with the measurement"})
      .check([](const Calibration& c) -> std::string {
        return c.um_per_px >= kMinScale
                   ? ""
                   : fmt::format("um_per_px is {:g}; it must be between 0.001 and 1000", c.um_per_px);
      });
}

Calibration read_calibration(const std::filesystem::path& file) {
  const Document d = read_toml(file);
  if (!d.root.contains("scale"))
    throw Error(Errc::usage, file.string(),
                "is not a calibration file: section [scale] not found; `faba scale --out` writes one");
  return Calibration::schema().parse(Node(d).child("scale"),
                                     {"iteration", "field_unit", "nominal_um_per_px", "um_per_px_source"});
}

void write_calibration(const std::filesystem::path& file, const Calibration& calibration) {
  const Json j = {{"scale", Calibration::schema().to_json(calibration)}};
  write_file(file, to_toml(j));
}

Calibration parse_calibration(const std::string& text, const std::string& where) {
  Quantity q;
  try {
    q = parse_quantity(text);
  } catch (const std::invalid_argument&) {
    std::error_code ec;
    if (std::filesystem::exists(text, ec)) return read_calibration(text);
    throw Error(
        Errc::usage, where,
        fmt::format(
            "\"{}\" is neither a number in um/px nor an existing calibration file; `faba scale` writes one",
            text));
  }
  const bool bare = q.dimension == Dimension{};
  if (!bare && q.dimension != parse_unit("um/px").dimension)
    throw Error(Errc::usage, where, fmt::format("\"{}\" is not a scale; give it in um/px", text));
  Calibration c;
  c.um_per_px = bare ? q.value : q.value * 1e6;
  c.method = "given";
  if (!(c.um_per_px >= kMinScale && c.um_per_px <= kMaxScale))
    throw Error(Errc::usage, where,
                fmt::format("\"{}\" is out of range; it must be between 0.001 and 1000 um/px", text));
  return c;
}

void include_calibration(Document& scenario) {
  if (!scenario.root.is_object() || !scenario.root.contains("scale") || !scenario.root["scale"].is_object())
    return;
  Json& scale = scenario.root["scale"];
  if (!scale.contains("file")) return;
  const Node node = Node(scenario).child("scale").child("file");
  if (!scale["file"].is_string()) node.fail("expected a string: the name of a calibration file");
  if (scale.contains("um_per_px")) node.fail("um_per_px is also given; give only one of them");
  const std::string named = scale["file"].get<std::string>();
  const std::filesystem::path file = node.file(named);
  std::error_code ec;
  if (!std::filesystem::exists(file, ec))
    node.fail(
        fmt::format("{} not found, neither relative to the scenario nor to the working directory; "
                    "`faba scale --out` writes one",
                    named));
  const Calibration calibration = read_calibration(file);
  scale.erase("file");
  scale["um_per_px"] = calibration.um_per_px;
  scale["um_per_px_source"] = "calibration";
  scenario.origin["scale.um_per_px"] = file.string();
}

}  // namespace faba
