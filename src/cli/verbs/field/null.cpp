#include <fmt/format.h>

#include <CLI/CLI.hpp>

#include "cli/command_line.h"
#include "cli/options/field.h"
#include "cli/provenance.h"
#include "study/pages/field_report.h"

namespace faba::cli {
namespace {

struct FieldNullVerb {
  std::filesystem::path rig;
  std::string at = "0 mm, 0 mm", polarity = "north";
};

int field_null(const FieldNullVerb& v, const Common& c) {
  const RigNull found = null_of_rig(v.rig, position("--at", v.at), v.polarity == "south" ? -1 : 1);
  if (c.json) {
    print_json(field_json(found), provenance_of(c, {v.rig}));
    return 0;
  }
  if (c.quiet) return 0;
  for (std::size_t k = 0; k < found.coils.size(); ++k)
    fmt::print("{:<12}{:>12.6g} A\n", found.coils[k], found.null.current[k]);
  fmt::print("gradient    {:.4g} and {:.4g} T/m in the plane, {:.4g} T/m along z\n", found.null.gradient[0],
             found.null.gradient[1], found.null.out_of_plane);
  if (!found.note.empty()) print_stderr(fmt::format("faba: note: {}: {}", v.rig.string(), found.note));
  return 0;
}

}  // namespace

void add_field_null(CLI::App& field, CommandLine& line) {
  const auto o = std::make_shared<FieldNullVerb>();
  CLI::App* v =
      verb(field, line, "null",
           "Compute the currents that produce a zero of the field at a position and trap cells there",
           "  faba field null rigs/thesis-four-coils.toml --at \"1 mm, 0 mm\"\n"
           "  faba field null rigs/thesis-four-coils.toml --at \"1 mm, 0 mm\" --polarity south");
  add_rig_file(v, o->rig);
  v->add_option("--at", o->at, "Position in the plane of the sample, x and y; default: \"" + o->at + '"');
  v->add_option("--polarity", o->polarity,
                "Cells to trap: north-seeking or south-seeking; default: " + o->polarity)
      ->check(one_of({"north", "south"}));
  v->callback([o, &line] { line.code = field_null(*o, line.common); });
}

}  // namespace faba::cli
