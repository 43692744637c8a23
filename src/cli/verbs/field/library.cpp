#include <fmt/format.h>

#include <CLI/CLI.hpp>

#include "cli/command_line.h"
#include "cli/options/field.h"
#include "cli/output_file.h"
#include "cli/progress.h"
#include "core/error.h"
#include "study/pages/field_report.h"

namespace faba::cli {
namespace {

struct FieldLibraryVerb {
  std::filesystem::path rig, out;
  std::string size = "2 mm, 2 mm", spacing;
  int levels = 0;
  unsigned threads = 0;
  bool force = false;
};

int field_library(const FieldLibraryVerb& v, const Common& c) {
  check_output(v.out, "", v.force, {v.rig});
  FieldLibraryOptions o;
  const Vec2 size = rectangle(v.size);
  o.width = size.x;
  o.height = size.y;
  if (!v.spacing.empty()) o.spacing = metres("--spacing", v.spacing);
  if (!(o.spacing >= 0)) throw Error(Errc::usage, "--spacing", "must not be negative");
  o.levels = v.levels;
  o.threads = v.threads;
  o.force = v.force;
  Progress bar("library", !c.json && !c.quiet);
  o.progress = [&](std::uint64_t done, std::uint64_t total) { bar.update(done, total); };
  o.stop = [&stop = stop_requested()] { return stop.load(); };
  const FieldLibrarySummary made = build_field_library(v.rig, v.out, o);
  bar.clear();
  if (c.json) {
    fmt::print("{}\n", field_json(made).dump());
    return 0;
  }
  if (c.quiet) return 0;
  fmt::print("{} entries of {} x {} nodes, from {} sets of currents\n", made.entries, made.columns, made.rows,
             made.combinations);
  if (made.off)
    fmt::print(
        "nearest zero {:.3g} um away in the median, {:.3g} um at most; the solver's is at the place itself\n",
        made.off->median * 1e6, made.off->largest * 1e6);
  if (made.strength)
    fmt::print("trap {:.3g} times as strong as the solver's in the median\n", *made.strength);
  if (made.entries == 0)
    tell(
        "faba: note: no set of currents makes a zero of the field in this rectangle; a library needs two "
        "coils at least");
  else if (made.traps == 0)
    tell("faba: note: all zeros are saddles, which drive cells away along one direction");
  fmt::print("  {}\n", v.out.string());
  return 0;
}

}  // namespace

void add_field_library(CLI::App& field, CommandLine& line) {
  const auto o = std::make_shared<FieldLibraryVerb>();
  CLI::App* v =
      verb(field, line, "library", "Many sets of currents with the zeros that they make, as in the thesis",
           "  faba field library rigs/thesis-four-coils.toml --out four.h5\n"
           "  faba field library rigs/thesis-two-coils.toml --size \"1 mm, 1 mm\" --levels 200 --out two.h5");
  add_rig_file(v, o->rig);
  v->add_option("-o,--out", o->out, "HDF5 file to write; what a stopped build left is gone on with")
      ->required()
      ->check(not_empty);
  v->add_option("--size", o->size, "Width and height of the rectangle that zeros are wanted in");
  v->add_option("--spacing", o->spacing, "Of the grid; a 64th of the longer side unless given")
      ->check(not_empty);
  v->add_option("--levels", o->levels, "Steps from no current to the largest")->check(CLI::Range(1, 100000));
  v->add_option("--threads", o->threads, "Threads to work with; all of the machine's unless given")
      ->check(CLI::Range(1u, 1024u));
  v->add_flag("--force", o->force, "Replace an existing library");
  v->callback([o, &line] { line.code = field_library(*o, line.common); });
}

}  // namespace faba::cli
