#include <CLI/CLI.hpp>

#include "cli/command_line.h"
#include "cli/verbs.h"

namespace faba::cli {

void add_field_verbs(CLI::App& app, CommandLine& line) {
  const auto o = std::make_shared<FieldVerb>();
  const auto l = std::make_shared<LibraryVerb>();
  const auto map_picture = std::make_shared<std::filesystem::path>("field.png");
  CLI::App* field = app.add_subcommand("field", "Magnetic field of a rig of coils");
  field->require_subcommand(1);
  CLI::App* v = verb(*field, line, "at", "B at points: CSV in, CSV out, SI units",
                     "  faba field at rigs/thesis-four-coils.toml --points points.csv > b.csv");
  v->add_option("rig", o->rig, "Rig file (TOML)")->required();
  v->add_option("--points", o->points, "CSV with the columns x_m,y_m,z_m")->required();
  v->callback([o, &line] { line.code = field_at(*o, line.common); });
  v = verb(*field, line, "map", "The field in the plane of the sample, as a picture and as HDF5",
           "  faba field map rigs/thesis-four-coils.toml --current 0.5,0.5,0.5,0.5\n"
           "  faba field map rigs/helmholtz.toml --current 1,0 --size \"20 mm, 20 mm\" --picture h.png --out "
           "h.h5");
  v->add_option("rig", o->rig, "Rig file (TOML)")->required();
  v->add_option("--current", o->current, "Currents in A, one per coil: 0.5,0.5,0,0");
  v->add_option("--size", o->size, "Width and height of the rectangle about the centre");
  v->add_option("--view", o->view, "Width and height of the camera's view, to be drawn in")->check(not_empty);
  v->add_option("--drop", o->drop, "Radius of the drop, to be drawn in")->check(not_empty);
  v->add_option("--picture", *map_picture, "Picture to write, PNG")->check(not_empty);
  v->add_option("-o,--out", o->out, "HDF5 file to write")->check(not_empty);
  v->add_flag("--check", o->check, "Only say how far the table that a swarm swims in is from the field");
  v->add_flag("--force", o->force, "Replace existing files");
  v->callback([map_picture, o, &line] {
    o->picture = *map_picture;
    line.code = field_map(*o, line.common);
  });
  v = verb(*field, line, "null", "Currents that put a zero of the field at a place and trap cells there",
           "  faba field null rigs/thesis-four-coils.toml --at \"1 mm, 0 mm\"\n"
           "  faba field null rigs/thesis-four-coils.toml --at \"1 mm, 0 mm\" --polarity south");
  v->add_option("rig", o->rig, "Rig file (TOML)")->required();
  v->add_option("--at", o->at, "Place in the plane of the sample, x and y");
  v->add_option("--polarity", o->polarity, "Cells to trap: north or south seeking")
      ->check(CLI::IsMember({"north", "south"}));
  v->callback([o, &line] { line.code = field_null(*o, line.common); });

  v = verb(*field, line, "tolerance",
           "How far a zero of the field moves when the rig is not as its file says",
           "  faba field tolerance rigs/thesis-two-coils.toml\n"
           "  faba field tolerance rigs/thesis-four-coils.toml --at \"1 mm, 0 mm\" --picture tolerance.svg");
  v->add_option("rig", o->rig, "Rig file (TOML)")->required();
  v->add_option("--at", o->at, "Place of the zero in the plane of the sample, x and y");
  v->add_option("--picture", o->picture, "Plot to write, SVG")->check(not_empty);
  v->add_flag("--force", o->force, "Replace an existing plot");
  v->callback([o, &line] { line.code = field_tolerance(*o, line.common); });
  v = verb(*field, line, "fit", "Bring a rig to a measured field: strength, place, and what no coil makes",
           "  faba field fit rigs/flat-coil.toml --map measured.csv\n"
           "  faba field fit rig.toml --map measured.h5 --out fitted.toml --picture left-over.svg");
  v->add_option("rig", o->rig, "Rig file (TOML), with the currents of the measurement")->required();
  v->add_option("--map", o->measured, "Measured field: CSV or HDF5, see `faba parts field map`")->required();
  v->add_option("-o,--out", o->out, "Rig file to write, with what was found")->check(not_empty);
  v->add_option("--picture", o->picture, "Plot of what is left over, SVG")->check(not_empty);
  v->add_flag("--force", o->force, "Replace existing files");
  v->callback([o, &line] { line.code = field_fit(*o, line.common); });
  v = verb(*field, line, "library", "Many sets of currents with the zeros that they make, as in the thesis",
           "  faba field library rigs/thesis-four-coils.toml --out four.h5\n"
           "  faba field library rigs/thesis-two-coils.toml --size \"1 mm, 1 mm\" --levels 200 --out two.h5");
  v->add_option("rig", l->rig, "Rig file (TOML)")->required();
  v->add_option("-o,--out", l->out, "HDF5 file to write; what a stopped build left is gone on with")
      ->required()
      ->check(not_empty);
  v->add_option("--size", l->size, "Width and height of the rectangle that zeros are wanted in");
  v->add_option("--spacing", l->spacing, "Of the grid; a 64th of the longer side unless given")
      ->check(not_empty);
  v->add_option("--levels", l->levels, "Steps from no current to the largest")->check(CLI::Range(1, 100000));
  v->add_option("--threads", l->threads, "Threads to work with; all of the machine's unless given")
      ->check(CLI::Range(1u, 1024u));
  v->add_flag("--force", l->force, "Replace an existing library");
  v->callback([l, &line] { line.code = field_library(*l, line.common); });
}

}  // namespace faba::cli
