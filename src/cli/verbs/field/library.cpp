#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <algorithm>

#include "cli/command_line.h"
#include "cli/options/field.h"
#include "cli/output_file.h"
#include "cli/progress.h"
#include "cli/provenance.h"
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
  check_output(v.out, {".h5", ".hdf5"}, v.force, {v.rig});
  FieldLibraryOptions o;
  const Vec2 size = rectangle(v.size);
  o.width = size.x;
  o.height = size.y;
  if (!v.spacing.empty()) o.spacing = metres("--spacing", v.spacing);
  if (!v.spacing.empty() && !(o.spacing > 0))
    throw Error(Errc::usage, "--spacing",
                fmt::format("\"{}\" is out of range; it must be positive and at most the longer side of the "
                            "rectangle ({:g} mm); omit the option for a 64th of this side",
                            v.spacing, std::max(o.width, o.height) * 1e3));
  if (o.spacing > std::max(o.width, o.height))
    throw Error(Errc::usage, "--spacing",
                fmt::format("{} is larger than the rectangle ({:g} mm x {:g} mm); use a smaller spacing",
                            v.spacing, o.width * 1e3, o.height * 1e3));
  o.levels = v.levels;
  o.threads = v.threads;
  o.force = v.force;
  Progress bar("library", !c.json && !c.quiet);
  o.progress = [&](std::uint64_t done, std::uint64_t total) { bar.update(done, total); };
  o.stop = [&stop = stop_requested()] { return stop.load(); };
  const FieldLibrarySummary library = build_field_library(v.rig, v.out, o);
  bar.clear();
  if (c.json) {
    print_json(field_json(library), provenance_of(c, {v.rig}));
    return 0;
  }
  if (c.quiet) return 0;
  fmt::print("{} entries of {} x {} nodes, from {} sets of currents\n", library.entries, library.columns,
             library.rows, library.combinations);
  if (library.off)
    fmt::print("distance to the nearest zero: median {:.3g} um, maximum {:.3g} um (solver: 0)\n",
               library.off->median * 1e6, library.off->largest * 1e6);
  if (library.strength)
    fmt::print("trap strength relative to the solver: median {:.3g}\n", *library.strength);
  if (library.entries == 0)
    print_stderr(
        "faba: note: no set of currents gives an isolated zero of the field in this rectangle; "
        "the library is empty. Use at least two coils whose fields have gradients, or a larger --size");
  else if (library.traps == 0)
    print_stderr("faba: note: all zeros are saddles, which drive cells away along one direction");
  fmt::print("  {}\n", v.out.string());
  return 0;
}

}  // namespace

void add_field_library(CLI::App& field, CommandLine& line) {
  const auto o = std::make_shared<FieldLibraryVerb>();
  CLI::App* v = verb(
      field, line, "library", "Compute many sets of currents and their zeros of the field, as in the thesis",
      "  faba field library rigs/thesis-four-coils.toml --out four.h5\n"
      "  faba field library rigs/thesis-two-coils.toml --size \"1 mm, 1 mm\" --levels 200 --out two.h5");
  add_rig_file(v, o->rig);
  v->add_option("-o,--out", o->out,
                "HDF5 file (.h5 or .hdf5) to write; an interrupted computation is resumed")
      ->required()
      ->check(not_empty)
      ->type_name("FILE.h5");
  v->add_option("--size", o->size,
                "Width and height of the rectangle of the zeros; default: \"" + o->size + '"');
  v->add_option("--spacing", o->spacing, "Spacing of the grid; default: a 64th of the longer side")
      ->check(not_empty);
  v->add_option(
       "--levels", o->levels,
       "Number of steps from zero current to the maximum; default: the largest number up to 100 with at most "
       "4 million sets of currents")
      ->check(integers(1, 100000));
  v->add_option("--threads", o->threads, "Number of threads; default: all threads of the machine")
      ->check(integers(1, 1024));
  v->add_flag("--force", o->force, "Replace an existing library");
  v->callback([o, &line] { line.code = field_library(*o, line.common); });
}

}  // namespace faba::cli
