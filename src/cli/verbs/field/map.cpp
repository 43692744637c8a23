#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <cmath>
#include <cstdlib>
#include <sstream>

#include "app/scenario/rig_file.h"
#include "cli/command_line.h"
#include "cli/options/field.h"
#include "cli/output_file.h"
#include "cli/provenance.h"
#include "core/error.h"
#include "study/pages/field_report.h"

namespace faba::cli {
namespace {

struct FieldMapVerb {
  std::filesystem::path rig;
  std::string size = "6 mm, 4.5 mm", current, view, drop;
  std::filesystem::path picture = "field.png", out;
  bool check = false, force = false;
};

std::vector<double> amperes(const std::string& text) {
  std::vector<double> out;
  std::istringstream in(text);
  for (std::string item; std::getline(in, item, ',');) {
    char* end = nullptr;
    out.push_back(std::strtod(item.c_str(), &end));
    if (end == item.c_str() || *end != '\0' || !std::isfinite(out.back()))
      throw Error(Errc::usage, "--current",
                  fmt::format("\"{}\" is not a number; give currents in A, such as 0.5,0.5,0,0", item));
  }
  return out;
}

// Rounded to four decimals, without a negative zero.
double millimetres(double metres) { return std::round(metres * 1e7) / 1e4 + 0.0; }

// The kind of a zero in words; the names of kinds in the JSON do not change.
std::string words_of(std::string kind) {
  const std::string suffix = "-seekers";
  if (kind.ends_with(suffix)) kind.replace(kind.size() - suffix.size(), suffix.size(), "-seeking cells");
  return kind;
}

void print_map(const FieldMap& map, bool all) {
  for (const FieldMap::Zero& z : map.zeros)
    fmt::print("zero at ({:.4f}, {:.4f}) mm: {}, gradients {:.3g} and {:.3g} T/m\n", millimetres(z.at.x),
               millimetres(z.at.y), words_of(z.kind), z.gradient[0], z.gradient[1]);
  if (all && !map.note.empty()) print_stderr("faba: note: " + map.note);
  if (all) fmt::print("maximum field {:.4g} mT\n", map.strongest * 1e3);
  if (map.table)
    fmt::print(
        "interpolation table {} x {} nodes, spacing {:.3g} um; maximum interpolation error {:.1e} of the "
        "maximum field of a coil\n",
        map.table->columns, map.table->rows, map.table->spacing * 1e6, map.table->error);
}

int field_map(const FieldMapVerb& v, const Common& c) {
  FieldMapOptions o;
  const Vec2 size = rectangle(v.size);
  o.width = size.x;
  o.height = size.y;
  o.current = amperes(v.current);
  if (!v.view.empty()) o.view = position("--view", v.view);
  if (!v.drop.empty()) o.drop_radius = metres("--drop", v.drop);
  if (o.drop_radius < 0)
    throw Error(Errc::usage, "--drop",
                fmt::format("{:g} m is negative; it must be at least 0 m", o.drop_radius));
  if (const double reach = std::hypot(o.width, o.height) / 2; o.drop_radius > reach)
    throw Error(
        Errc::usage, "--drop",
        fmt::format("\"{}\" is out of range; for a map of {:g} mm x {:g} mm it must be at most {:.4g} mm, "
                    "half of the diagonal; use a smaller radius or a larger --size",
                    v.drop, 1e3 * o.width, 1e3 * o.height, 1e3 * reach));
  read_rig(v.rig, builtin_parts());  // errors of the input come before those of the output
  if (!v.check) {
    if (v.picture == FieldMapVerb{}.picture && !v.force && std::filesystem::exists(v.picture))
      throw Error(Errc::usage, v.picture.string(),
                  "already exists; give another name with --picture, or --force to replace it");
    o.picture = v.picture;
    o.hdf5 = v.out;
    check_distinct({o.picture, o.hdf5});
    check_output(o.picture, {".png"}, v.force, {v.rig});
    check_output(o.hdf5, {".h5", ".hdf5"}, v.force, {v.rig});
  }
  const FieldMap map = faba::field_map(v.rig, o);
  if (c.json) {
    print_json(field_json(map), provenance_of(c, {v.rig}));
    return 0;
  }
  if (c.quiet) return 0;
  print_map(map, !v.check);
  for (const auto& file : {o.picture, o.hdf5})
    if (!file.empty()) fmt::print("  {}\n", file.string());
  return 0;
}

}  // namespace

void add_field_map(CLI::App& field, CommandLine& line) {
  const auto o = std::make_shared<FieldMapVerb>();
  CLI::App* v =
      verb(field, line, "map", "Map the field in the plane of the sample, as a picture and as HDF5",
           "  faba field map rigs/thesis-four-coils.toml --current 0.5,0.5,0.5,0.5\n"
           "  faba field map rigs/helmholtz.toml --current 1,0 --size \"20 mm, 20 mm\" --picture h.png --out "
           "h.h5");
  add_rig_file(v, o->rig);
  v->add_option("--current", o->current,
                "Currents in A, one per coil: 0.5,0.5,0,0; default: `current` of each coil");
  v->add_option("--size", o->size,
                "Width and height of the rectangle around the centre; default: \"" + o->size + '"');
  v->add_option("--view", o->view, "Width and height of the camera view, to draw it; default: not drawn")
      ->check(not_empty);
  v->add_option("--drop", o->drop, "Radius of the drop, to draw it; default: not drawn")->check(not_empty);
  v->add_option("--picture", o->picture, "Picture to write, as PNG; default: " + o->picture.string())
      ->check(not_empty);
  v->add_option("-o,--out", o->out, "HDF5 file (.h5 or .hdf5) to write; default: none")->check(not_empty);
  v->add_flag("--check", o->check,
              "Write nothing; print the error of the field table that a simulation would use");
  v->add_flag("--force", o->force, "Replace existing files");
  v->callback([o, &line] { line.code = field_map(*o, line.common); });
}

}  // namespace faba::cli
