#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <algorithm>
#include <map>
#include <nlohmann/json.hpp>

#include "cli/command_line.h"
#include "cli/provenance.h"
#include "study/optics/optics_verdicts.h"
#include "study/pages/optics_report.h"

namespace faba::cli {
namespace {

/// Values of the options by the key of OpticsSetup::schema(); empty if not given.
using OpticsOptions = std::map<std::string, std::string>;

std::string option_of(const std::string& key) {
  if (key == "preset") return "--objective";
  std::string name = "--" + key;
  std::replace(name.begin(), name.end(), '_', '-');
  return name;
}

OpticsSetup setup_of(const OpticsOptions& options) {
  Document d;
  d.name = "faba optics";
  for (const auto& [key, text] : options)
    if (!text.empty()) d.set(key, text, option_of(key));
  return OpticsSetup::schema().parse(Node(d));
}

void print_setup(const OpticsSetup& o, const OpticsPlan& p) {
  fmt::print("objective     {:g}x, NA {:g}: resolution {:.2g} um, depth of field {:.2g} um\n",
             o.magnification, o.numerical_aperture, 1e6 * p.resolution, 1e6 * p.depth_of_field);
  fmt::print("camera        {} x {} px, {:g} frames per second, exposure {:.3g} ms\n", o.width_px,
             o.height_px, o.frame_rate, 1e3 * p.exposure_time);
  fmt::print("scale         {:.4g} um/px\n", p.um_per_px);
  fmt::print("view          {:.3g} x {:.3g} um\n", 1e6 * p.view_width, 1e6 * p.view_height);
  fmt::print("cell          {:.3g} px; its picture is {:.2g} px wide\n", p.cell_px, p.object_px);
  fmt::print("density       {:.3g} cells in view, mean distance {:.3g} px\n", p.cells_in_view, p.spacing_px);
  fmt::print("displacement  {:.3g} px between frames, {:.2g} px during the exposure\n", p.displacement_px,
             p.blur_px);
  fmt::print("crossing      {:.3g} s, {:.3g} frames\n", p.crossing_time, p.crossing_frames);
  fmt::print("gathering     {:.3g} s to the edge of a drop of radius {:.3g} mm\n\n", p.gathering_time,
             1e3 * o.drop_radius);
}

void print_verdict(const OpticsVerdict& v) {
  fmt::print("{:<29} {:<9} {}\n", title_of(v.measurement), word_of(v.quality()), v.evidence);
  for (Warning w : v.warnings) {
    if (w.evidence == v.evidence) w.evidence.clear();
    fmt::print("    {}\n", sentence(w));
  }
}

int optics(const OpticsOptions& options, const Common& c) {
  const OpticsSetup setup = setup_of(options);
  if (c.json) {
    print_json(optics_json(setup), provenance_of(c, {}));
    return 0;
  }
  const OpticsPlan plan = optics_plan(setup);
  if (!c.quiet) print_setup(setup, plan);
  for (const OpticsVerdict& v : optics_verdicts(setup, plan)) print_verdict(v);
  return 0;
}

// What the help shows as the default of an option.
std::string default_of(const Json& value) {
  if (value.is_null()) return "";
  return fmt::format("; default: {}", value.is_string() ? value.get<std::string>() : value.dump());
}

}  // namespace

void add_optics(CLI::App& app, CommandLine& line) {
  const auto o = std::make_shared<OpticsOptions>();
  CLI::App* v =
      verb(app, line, "optics", "Plan objective, camera and frame rate: which measurement will be valid",
           "  faba optics\n"
           "  faba optics --objective 100x\n"
           "  faba optics --objective 20x --frame-rate \"120 Hz\" --speed \"140 um/s\"");
  const Json schema = OpticsSetup::schema().json_schema();
  const Json& properties = schema["properties"];
  v->add_option("--objective", (*o)["preset"],
                "Magnification and numerical aperture of an objective; default: 10x")
      ->check(one_of(properties["preset"]["enum"].get<std::vector<std::string>>()));
  for (const auto& [key, f] : properties.items())
    if (key != "preset")
      v->add_option(option_of(key), (*o)[key],
                    f["description"].get<std::string>() + default_of(f.value("default", Json())))
          ->check(not_empty);
  v->callback([o, &line] { line.code = optics(*o, line.common); });
}

}  // namespace faba::cli
