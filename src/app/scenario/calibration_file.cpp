#include "app/scenario/calibration_file.h"

#include <fmt/format.h>

#include <cmath>
#include <stdexcept>

#include "core/file.h"
#include "core/units.h"

namespace faba {
namespace {

constexpr double kLeast = 1e-3, kMost = 1e3;  // um/px, as in a scenario

}  // namespace

Schema<Calibration> Calibration::schema() {
  return Schema<Calibration>("calibration", "The scale of a camera, as faba scale writes it")
      .add("um_per_px", &Calibration::um_per_px, {.min = 0, .max = kMost, .doc = "Micrometres per pixel"})
      .add("ci95", &Calibration::ci95, {.doc = "Ends of its 95 % interval, um/px"})
      .add("method", &Calibration::method, {.doc = "How it was found"})
      .add("source", &Calibration::source, {.doc = "The file that it was found from"})
      .check([](const Calibration& c) -> std::string {
        return c.um_per_px >= kLeast ? "" : "needs um_per_px, 0.001 to 1000";
      });
}

Calibration read_calibration(const std::filesystem::path& file) {
  const Document d = read_toml(file);
  if (!d.root.contains("scale"))
    throw Error(Errc::usage, file.string(),
                "is no calibration: it has no [scale]; `faba scale --out` writes one");
  return Calibration::schema().parse(Node(d).child("scale"), {"iteration", "field_unit"});
}

void write_calibration(const std::filesystem::path& file, const Calibration& calibration) {
  const Json j = {{"scale", Calibration::schema().to_json(calibration)}};
  write_file(file, to_toml(j));
}

Calibration parse_calibration(const std::string& words, const std::string& where) {
  Quantity q;
  try {
    q = parse_quantity(words);
  } catch (const std::invalid_argument&) {
    std::error_code ec;
    if (std::filesystem::exists(words, ec)) return read_calibration(words);
    throw Error(Errc::usage, where,
                fmt::format("{} is neither a number of um/px nor a file; `faba scale` makes one", words));
  }
  const bool bare = q.dimension == Dimension{};
  if (!bare && q.dimension != parse_unit("um/px").dimension)
    throw Error(Errc::usage, where, fmt::format("{} is no scale; write it in um/px", words));
  Calibration c;
  c.um_per_px = bare ? q.value : q.value * 1e6;
  c.method = "given";
  if (!(c.um_per_px >= kLeast && c.um_per_px <= kMost))
    throw Error(Errc::usage, where, fmt::format("{} is outside 0.001 to 1000 um/px", words));
  return c;
}

void include_calibration(Document& scenario) {
  if (!scenario.root.is_object() || !scenario.root.contains("scale") || !scenario.root["scale"].is_object())
    return;
  Json& scale = scenario.root["scale"];
  if (!scale.contains("file")) return;
  const Node node = Node(scenario).child("scale").child("file");
  if (!scale["file"].is_string()) node.fail("expected the name of a calibration file in quotes");
  if (scale.contains("um_per_px")) node.fail("um_per_px is given beside it; keep the one that is to count");
  const std::string named = scale["file"].get<std::string>();
  const std::filesystem::path file = node.file(named);
  std::error_code ec;
  if (!std::filesystem::exists(file, ec))
    node.fail(
        fmt::format("there is no {}, neither beside the scenario nor where the program was called; "
                    "`faba scale --out` writes one",
                    named));
  const Calibration calibration = read_calibration(file);
  scale.erase("file");
  scale["um_per_px"] = calibration.um_per_px;
  scenario.origin["scale.um_per_px"] = file.string();
}

}  // namespace faba
