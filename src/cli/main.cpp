#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <algorithm>
#include <cctype>
#include <csignal>
#include <cstdio>
#include <cstring>
#include <ctime>
#include <new>

#include "cli/verbs.h"
#include "core/schema.h"

namespace faba::cli {
namespace {

std::atomic<bool> stop{false};
std::string called_as = "faba";

void complain(const std::string& text) { tell("faba: error: " + text); }

CLI::App* verb(CLI::App& app, Common& common, const char* name, const char* does, const char* examples) {
  CLI::App* v = app.add_subcommand(name, does);
  v->add_flag("--json", common.json, "One JSON object on standard output and nothing else there");
  v->add_flag("-q,--quiet", common.quiet, "No progress bar, no notes and no summary");
  v->footer(fmt::format(
      "Examples:\n{}\n\nExit codes: 0 done, 2 usage or scenario error, 3 unreadable or unsuitable input, "
      "130 interrupted, 1 anything else",
      examples));
  return v;
}

std::string not_empty(const std::string& word) { return word.empty() ? "must not be empty" : ""; }

// CLI11 would say that a verb is missing.
void check_verb(const CLI::App& app, const std::string& word) {
  std::vector<std::string> known;
  for (const CLI::App* v : app.get_subcommands({})) known.push_back(v->get_name());
  if (std::find(known.begin(), known.end(), word) == known.end())
    throw Error(Errc::usage, word, "is no verb" + suggestion(word, known));
}

int dispatch(int argc, char** argv) {
  if (argc > 0) called_as = argv[0];
  CLI::App app{
      "Faba, a laboratory for magnetotactic bacteria: simulate a swarm under coils, steer it, record it"};
  app.name("faba");
  app.set_version_flag("--version", "faba " FABA_VERSION);
  app.require_subcommand(1);
  app.footer("Each verb in full: faba VERB --help\nFirst steps: faba run scenes/steer.toml");
  Common common;
  int code = 0;

  RunVerb run_options;
  auto* v =
      verb(app, common, "run", "Run a scenario: the closed loop, headless and recorded",
           "  faba run scenes/steer.toml\n"
           "  faba run scenes/thesis-basic.toml --seed 7 --out runs/a --set swarm[0].model.max_speed=5\n"
           "  faba run scenes/drop.toml --from-video drop.tif --duration \"10 s\"");
  v->add_option("scene", run_options.scene, "Scenario file (TOML)")->required();
  v->add_option("--set", run_options.set, "Change one value: PATH=VALUE")
      ->take_all()
      ->allow_extra_args(false);
  v->add_option("--seed", run_options.seed, "Seed of all randomness; drawn and printed when absent");
  v->add_option("--threads", run_options.threads,
                "Threads; all of the machine's when absent. Never changes the result")
      ->check(CLI::Range(1, 1024));
  v->add_option("-o,--out", run_options.out, "Run directory; runs/SCENE-SEED when absent")->check(not_empty);
  v->add_option("--duration", run_options.duration, "Simulated time, such as \"10 s\"");
  v->add_option("--from-video", run_options.from_video, "Take the drop's edge from this picture or video")
      ->check(not_empty);
  v->add_flag("--force", run_options.force, "Replace an earlier run in the directory");
  v->callback([&] { code = run(run_options, common); });

  ResumeVerb resume_options;
  v = verb(app, common, "resume", "Go on with an interrupted run from its last checkpoint",
           "  faba resume runs/steer-1");
  v->add_option("dir", resume_options.dir, "Run directory")->required();
  v->add_option("--threads", resume_options.threads, "Threads; all of the machine's when absent")
      ->check(CLI::Range(1, 1024));
  v->callback([&] { code = resume(resume_options, common); });

  DropVerb drop_options;
  v = verb(app, common, "drop", "Find the edge of a drop in a picture or in the first frame of a video",
           "  faba drop drop.tif --overlay edge.png\n  faba drop film.avi --json");
  v->add_option("picture", drop_options.picture, "TIFF, PNG, JPEG, PGM (8 or 16 bit) or any video")
      ->required();
  v->add_option("--overlay", drop_options.overlay, "Write the picture with the edge drawn in, as PNG")
      ->check(not_empty);
  v->add_flag("--force", drop_options.force, "Replace an existing overlay");
  v->callback([&] { code = drop(drop_options, common); });

  FieldVerb field_options;
  std::filesystem::path map_picture = "field.png";
  LibraryVerb library_options;
  CLI::App* field = app.add_subcommand("field", "Magnetic field of a rig of coils");
  field->require_subcommand(1);
  v = verb(*field, common, "at", "B at points: CSV in, CSV out, SI units",
           "  faba field at rigs/thesis-four-coils.toml --points points.csv > b.csv");
  v->add_option("rig", field_options.rig, "Rig file (TOML)")->required();
  v->add_option("--points", field_options.points, "CSV with the columns x_m,y_m,z_m")->required();
  v->callback([&] { code = field_at(field_options, common); });
  v = verb(*field, common, "map", "The field in the plane of the sample, as a picture and as HDF5",
           "  faba field map rigs/thesis-four-coils.toml --current 0.5,0.5,0.5,0.5\n"
           "  faba field map rigs/helmholtz.toml --current 1,0 --size \"20 mm, 20 mm\" --picture h.png --out "
           "h.h5");
  v->add_option("rig", field_options.rig, "Rig file (TOML)")->required();
  v->add_option("--current", field_options.current, "Currents in A, one per coil: 0.5,0.5,0,0");
  v->add_option("--size", field_options.size, "Width and height of the rectangle about the centre");
  v->add_option("--view", field_options.view, "Width and height of the camera's view, to be drawn in")
      ->check(not_empty);
  v->add_option("--drop", field_options.drop, "Radius of the drop, to be drawn in")->check(not_empty);
  v->add_option("--picture", map_picture, "Picture to write, PNG")->check(not_empty);
  v->add_option("-o,--out", field_options.out, "HDF5 file to write")->check(not_empty);
  v->add_flag("--check", field_options.check,
              "Only say how far the table that a swarm swims in is from the field");
  v->add_flag("--force", field_options.force, "Replace existing files");
  v->callback([&] {
    field_options.picture = map_picture;
    code = field_map(field_options, common);
  });
  v = verb(*field, common, "null", "Currents that put a zero of the field at a place and trap cells there",
           "  faba field null rigs/thesis-four-coils.toml --at \"1 mm, 0 mm\"\n"
           "  faba field null rigs/thesis-four-coils.toml --at \"1 mm, 0 mm\" --polarity south");
  v->add_option("rig", field_options.rig, "Rig file (TOML)")->required();
  v->add_option("--at", field_options.at, "Place in the plane of the sample, x and y");
  v->add_option("--polarity", field_options.polarity, "Cells to trap: north or south seeking")
      ->check(CLI::IsMember({"north", "south"}));
  v->callback([&] { code = field_null(field_options, common); });

  v = verb(*field, common, "tolerance",
           "How far a zero of the field moves when the rig is not as its file says",
           "  faba field tolerance rigs/thesis-two-coils.toml\n"
           "  faba field tolerance rigs/thesis-four-coils.toml --at \"1 mm, 0 mm\" --picture tolerance.svg");
  v->add_option("rig", field_options.rig, "Rig file (TOML)")->required();
  v->add_option("--at", field_options.at, "Place of the zero in the plane of the sample, x and y");
  v->add_option("--picture", field_options.picture, "Plot to write, SVG")->check(not_empty);
  v->add_flag("--force", field_options.force, "Replace an existing plot");
  v->callback([&] { code = field_tolerance(field_options, common); });
  v = verb(*field, common, "fit", "Bring a rig to a measured field: strength, place, and what no coil makes",
           "  faba field fit rigs/flat-coil.toml --map measured.csv\n"
           "  faba field fit rig.toml --map measured.h5 --out fitted.toml --picture left-over.svg");
  v->add_option("rig", field_options.rig, "Rig file (TOML), with the currents of the measurement")
      ->required();
  v->add_option("--map", field_options.measured, "Measured field: CSV or HDF5, see `faba parts field map`")
      ->required();
  v->add_option("-o,--out", field_options.out, "Rig file to write, with what was found")->check(not_empty);
  v->add_option("--picture", field_options.picture, "Plot of what is left over, SVG")->check(not_empty);
  v->add_flag("--force", field_options.force, "Replace existing files");
  v->callback([&] { code = field_fit(field_options, common); });
  v = verb(*field, common, "library", "Many sets of currents with the zeros that they make, as in the thesis",
           "  faba field library rigs/thesis-four-coils.toml --out four.h5\n"
           "  faba field library rigs/thesis-two-coils.toml --size \"1 mm, 1 mm\" --levels 200 --out two.h5");
  v->add_option("rig", library_options.rig, "Rig file (TOML)")->required();
  v->add_option("-o,--out", library_options.out,
                "HDF5 file to write; what a stopped build left is gone on with")
      ->required()
      ->check(not_empty);
  v->add_option("--size", library_options.size, "Width and height of the rectangle that zeros are wanted in");
  v->add_option("--spacing", library_options.spacing, "Of the grid; a 64th of the longer side unless given")
      ->check(not_empty);
  v->add_option("--levels", library_options.levels, "Steps from no current to the largest")
      ->check(CLI::Range(1, 100000));
  v->add_option("--threads", library_options.threads,
                "Threads to work with; all of the machine's unless given")
      ->check(CLI::Range(1u, 1024u));
  v->add_flag("--force", library_options.force, "Replace an existing library");
  v->callback([&] { code = field_library(library_options, common); });

  PartsVerb parts_options;
  v = verb(app, common, "parts", "What can be named in a scenario, with units, ranges, defaults and sources",
           "  faba parts\n  faba parts model\n  faba parts model dipole");
  v->add_option("kind", parts_options.kind,
                "model, start, arena, field, motility, estimator, reference, controller");
  v->add_option("name", parts_options.name, "One part in full");
  v->callback([&] { code = parts(parts_options, common); });

  v = verb(app, common, "schema", "JSON Schema of a scenario or rig file, for editors and forms",
           "  faba schema > scenario.json\n  faba schema rig > rig.json");
  std::string schema_of = "scenario";
  v->add_option("file", schema_of, "scenario (unless given) or rig")
      ->check(CLI::IsMember({"scenario", "rig"}));
  v->callback([&] { code = schema(schema_of, common); });
  v = verb(app, common, "doctor", "What this machine has", "  faba doctor");
  v->callback([&] { code = doctor(common); });

  std::vector<std::string> words(argv + 1, argv + argc);
  if (!words.empty() && words[0] == "help") {  // as others have it: faba help run
    words.erase(words.begin());
    words.emplace_back("--help");
  }
  if (!words.empty() && words[0].rfind('-', 0) != 0) check_verb(app, words[0]);
  if (words.size() > 1 && words[0] == "field" && words[1].rfind('-', 0) != 0) check_verb(*field, words[1]);
  try {
    app.parse(std::vector<std::string>(words.rbegin(), words.rend()));
  } catch (const CLI::ParseError& e) {
    if (e.get_exit_code() == 0) return app.exit(e);  // --help, --version
    const std::string help = argc > 1 && argv[1][0] != '-' ? fmt::format("{} {} --help", program(), argv[1])
                                                           : program() + " --help";
    throw Error(Errc::usage, "", fmt::format("{} (see {})", e.what(), help));
  }
  return code;
}

}  // namespace

const std::atomic<bool>& stop_requested() {
  // Some senders signal a process and its group: a repeat within half a second is the same wish.
  static std::atomic<long> first_ms{0};
  const auto on_signal = [](int) {
    timespec now{};
    clock_gettime(CLOCK_MONOTONIC, &now);
    const long ms = now.tv_sec * 1000 + now.tv_nsec / 1000000;
    if (!stop.exchange(true))
      first_ms = ms;
    else if (ms - first_ms > 500)
      _Exit(int(Errc::interrupted));
  };
  for (const int signal : {SIGINT, SIGTERM, SIGHUP}) std::signal(signal, on_signal);
  return stop;
}
const std::string& program() { return called_as; }

void tell(const std::string& line) {
  std::fputs((line + '\n').c_str(), stderr);
  std::fflush(stderr);
}

std::string shell_word(const std::string& word) {
  const bool plain = !word.empty() && std::all_of(word.begin(), word.end(), [](unsigned char c) {
    return std::isalnum(c) || std::strchr("_-./=:,+@%", c);
  });
  if (plain) return word;
  std::string out = "'";
  for (const char c : word) out += c == '\'' ? std::string("'\\''") : std::string(1, c);
  return out + "'";
}

}  // namespace faba::cli

int main(int argc, char** argv) {
  std::signal(SIGXFSZ, SIG_IGN);  // a file that may not grow is an error of writing
  std::signal(SIGPIPE, SIG_IGN);  // a reader that leaves early is an error of writing, not a death
  try {
    const int code = faba::cli::dispatch(argc, argv);
    if (std::fflush(stdout) != 0)
      throw faba::Error(faba::Errc::internal, "standard output", "cannot be written");
    return code;
  } catch (const faba::Error& e) {
    faba::cli::complain(e.what());
    return int(e.code());
  } catch (const std::bad_alloc&) {
    faba::cli::complain("out of memory; fewer cells, a smaller arena or a shorter run may fit");
  } catch (const std::exception& e) {
    faba::cli::complain(e.what());
  }
  return int(faba::Errc::internal);
}
