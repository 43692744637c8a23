#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <algorithm>
#include <cmath>

#include "cli/command_line.h"
#include "cli/options/field.h"
#include "cli/provenance.h"
#include "study/pages/field_report.h"

namespace faba::cli {
namespace {

struct FieldAtVerb {
  std::filesystem::path rig, points;
};

int field_at(const FieldAtVerb& v, const Common& c) {
  const FieldAtPoints f = field_at_points(v.rig, v.points);
  const auto unknown =
      std::count_if(f.b.begin(), f.b.end(), [](const Vec3& b) { return !std::isfinite(b.x + b.y + b.z); });
  if (unknown > 0 && !c.quiet)
    print_stderr(
        fmt::format("faba: note: {} of {} points are outside the measured region; the field there is NaN",
                    unknown, f.b.size()));
  if (!c.quiet && std::all_of(f.current.begin(), f.current.end(), [](double i) { return i == 0; }))
    print_stderr("faba: note: all currents are zero; set `current` of the coils in the coil system file");
  if (c.json) {
    print_json(field_json(f), provenance_of(c, {v.rig, v.points}));
    return 0;
  }
  std::string out = "x_m,y_m,z_m,bx_t,by_t,bz_t\n";
  for (std::size_t i = 0; i < f.at.size(); ++i)
    out += fmt::format("{:.17g},{:.17g},{:.17g},{:.17g},{:.17g},{:.17g}\n", f.at[i].x, f.at[i].y, f.at[i].z,
                       f.b[i].x, f.b[i].y, f.b[i].z);
  fmt::print("{}", out);
  return 0;
}

}  // namespace

void add_field_at(CLI::App& field, CommandLine& line) {
  const auto o = std::make_shared<FieldAtVerb>();
  CLI::App* v = verb(field, line, "at", "Compute B at points: CSV in, CSV out, SI units",
                     "  faba field at rigs/flat-coil.toml --points points.csv > b.csv");
  add_rig_file(v, o->rig);
  v->add_option("--points", o->points, "CSV file with the columns x_m,y_m,z_m")
      ->required()
      ->type_name("FILE.csv");
  v->callback([o, &line] { line.code = field_at(*o, line.common); });
}

}  // namespace faba::cli
