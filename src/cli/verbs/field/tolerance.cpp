#include <fmt/format.h>

#include <CLI/CLI.hpp>

#include "cli/command_line.h"
#include "cli/options/field.h"
#include "cli/output_file.h"
#include "cli/provenance.h"
#include "study/pages/field_report.h"

namespace faba::cli {
namespace {

struct FieldToleranceVerb {
  std::filesystem::path rig;
  std::string at = "0 mm, 0 mm";
  std::filesystem::path picture;
  bool force = false;
};

int field_tolerance(const FieldToleranceVerb& v, const Common& c) {
  check_output(v.picture, {".svg"}, v.force, {v.rig});
  const FieldTolerance tolerance = faba::field_tolerance(v.rig, position("--at", v.at), v.picture);
  if (c.json) {
    print_json(field_json(tolerance), provenance_of(c, {v.rig}));
    return 0;
  }
  if (c.quiet) return 0;
  fmt::print("{:<42}{}\n", "deviation from the file", "largest shift of the zero");
  std::string previous;
  for (const FieldTolerance::Row& row : tolerance.rows) {
    if (!previous.empty() && previous != row.cause) fmt::print("\n");
    previous = row.cause;
    fmt::print("{:<42}{}\n", row.words,
               row.shift ? fmt::format("{:>8.4f} mm", *row.shift * 1e3) : "the zero disappears");
  }
  if (!v.picture.empty()) fmt::print("  {}\n", v.picture.string());
  if (!tolerance.note.empty())
    print_stderr(fmt::format("faba: note: {}: {}", v.rig.string(), tolerance.note));
  return 0;
}

}  // namespace

void add_field_tolerance(CLI::App& field, CommandLine& line) {
  const auto o = std::make_shared<FieldToleranceVerb>();
  CLI::App* v =
      verb(field, line, "tolerance",
           "Displacement of a zero of the field when the coil system deviates from its file",
           "  faba field tolerance rigs/thesis-two-coils.toml\n"
           "  faba field tolerance rigs/thesis-four-coils.toml --at \"1 mm, 0 mm\" --picture tolerance.svg");
  add_rig_file(v, o->rig);
  v->add_option("--at", o->at,
                "Position of the zero in the plane of the sample, x and y; default: \"" + o->at + '"');
  v->add_option("--picture", o->picture, "Plot to write, as SVG")->check(not_empty);
  v->add_flag("--force", o->force, "Replace an existing plot");
  v->callback([o, &line] { line.code = field_tolerance(*o, line.common); });
}

}  // namespace faba::cli
