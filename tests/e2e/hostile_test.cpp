// Invalid input: one clear line, the documented exit code, nothing written.
#include <doctest/doctest.h>

#include <sys/wait.h>
#include <unistd.h>

#include <chrono>

#include "tests/e2e/program.h"

using namespace faba;

namespace {

struct Bad {
  const char* what;
  std::string scene;
  const char* message;
};

}  // namespace

TEST_CASE("invalid scenarios: exit 2, one line with file, line, path and reason, nothing written") {
  const TestFolder f;
  const std::string swarm = "[[swarm]]\ncount = 50\n";
  for (const Bad& b : {
           Bad{"truncated", "duration = '2 s'\n[[swarm", "s.toml:2"},
           Bad{"not TOML", "\x01\x02\xff\xfe", "s.toml:1"},
           Bad{"empty", "", "[[swarm]] is missing"},
           Bad{"misspelt key", swarm + "cuont = 3\n",
               "s.toml:3: swarm[0].cuont: unknown key; did you mean \"count\"?"},
           Bad{"misspelt section", swarm + "[controler]\ntype = 'fuzzy'\n", "did you mean \"controller\"?"},
           Bad{"wrong unit", "duration = '2 um'\n" + swarm, "is a length; expected a time"},
           Bad{"unknown unit", "duration = '2 parsec'\n" + swarm, "unknown unit \"parsec\""},
           Bad{"degrees Celsius", swarm + "model = { type = 'dipole', temperature = '20 degC' }\n",
               "20 degC is \"293.15 K\"; expected a temperature such as \"293 K\""},
           Bad{"degrees as a number", swarm + "heading = 180\n", "for degrees write \"180 deg\""},
           Bad{"a coil system", "[[coil]]\ntype = 'loop'\n", "is a coil system file; use `faba field`"},
           Bad{"a study of controllers", "scene = 'a.toml'\n[[controller]]\ntype = 'fuzzy'\n",
               "is a study for `faba compare-controllers`"},
           Bad{"NaN", "duration = nan\n" + swarm, "must be a finite number"},
           Bad{"huge", "duration = 1e300\n" + swarm, "out of range"},
           Bad{"huge integer", "seed = 99999999999999999999999\n" + swarm, "s.toml:1"},
           Bad{"negative", swarm + "model = { type = 'dipole', speed = '-1 um/s' }\n", "out of range"},
           Bad{"a million in a thousand",
               "[arena]\ntype = 'box'\nsize_px = [40, 25]\n[[swarm]]\ncount = 1000000\n",
               "at most 1000 pixels"},
           Bad{"1e18 cells", "[[swarm]]\ncount = 1000000000000000000\n", "out of range"},
           Bad{"unknown part", swarm + "model = 'dipol'\n",
               "unknown model \"dipol\"; did you mean \"dipole\"?"},
           Bad{"wrong type", "duration = [1]\n" + swarm, "expected a time such as \"1 s\", got [1]"},
           Bad{"part without type", swarm + "[controller]\nmax_output = 3\n", "key \"type\" is missing"},
           Bad{"duplicate key", "seed = 1\nseed = 2\n" + swarm, "s.toml:2"},
           Bad{"deep nesting", "a = " + std::string(100000, '[') + "\n", "s.toml:1"},
           Bad{"route without points", swarm + "[reference]\ntype = 'route'\n", "at least one setpoint"},
           Bad{"step that does not divide", swarm + "[simulation]\nstep = '40 ms'\n",
               "does not divide the frame period"},
           Bad{"a key of the top level below a table", "[camera]\nrate = 20\nduration = '2 s'\n" + swarm,
               "s.toml:3: camera.duration: is a top-level key"},
           Bad{"a start outside", swarm + "start = { type = 'disc', centre_px = [5000, 0] }\n",
               "is outside the arena"},
           Bad{"a binary file",
               std::string("\x7f"
                           "ELF\0\0",
                           6),
               "is a binary file"},
           Bad{"a video that cannot be", swarm + "[camera]\nrate = '100 kHz'\n",
               "a video cannot have 100000"},
           Bad{"a video that is too slow", swarm + "[record]\nvideo_every = 100000\n",
               "record.video_every: a video cannot have"},
           Bad{"a picture that cannot be", swarm + "[arena]\ntype = 'drop'\nview_px = [20000, 10]\n",
               "the maximum is 16384 px"},
           Bad{"an empty event", swarm + "[[event]]\n",
               "s.toml:3: event[0]: names no part; add at least one of the keys model, estimator, reference, "
               "controller"},
           Bad{"an event with a frame only", swarm + "[[event]]\nframe = 3\n", "event[0]: names no part"},
           Bad{"a date", "seed = 2020-01-01\n" + swarm, "dates and times"},
       }) {
    write_file(f.path / "s.toml", b.scene);
    const Called c = faba_in(f.path, "run s.toml --out out --seed 1 --quiet");
    INFO(b.what, ": ", c.err.substr(0, 400));
    CHECK(c.exit == 2);
    CHECK(one_clear_line(c.err));
    CHECK(c.err.find(b.message) != std::string::npos);
    CHECK(c.out.empty());
    CHECK_FALSE(std::filesystem::exists(f.path / "out"));
  }
}

TEST_CASE("invalid command lines: exit 2") {
  const TestFolder f;
  write_file(f.path / "s.toml", kSmallScene);
  for (const char* arguments :
       {"", "rnu", "run", "run none.toml --out out", "run . --out out", "run s.toml --frobnicate",
        "run s.toml --set count --out out", "run s.toml --set swarm[3].count=1 --out out",
        "run s.toml --set swarm[0].sped=1 --out out", "run s.toml --seed -1 --out out",
        "run s.toml --seed 99999999999999999999 --out out", "run s.toml --threads 0 --out out",
        "run s.toml --duration '3 um' --out out", "parts colour", "parts model ant",
        "run s.toml --out s.toml"}) {
    const Called c = faba_in(f.path, arguments);
    INFO("faba ", arguments, " -> ", c.exit, " ", c.err);
    CHECK(c.exit == 2);
    CHECK(one_clear_line(c.err));
    CHECK_FALSE(std::filesystem::exists(f.path / "out"));
  }
}

TEST_CASE("errors of the command line name the option or argument, with advice") {
  const TestFolder f;
  write_file(f.path / "s.toml", kSmallScene);
  const std::pair<const char*, const char*> cases[] = {
      {"", "a command is required"},
      {"run", "scene: argument is missing; usage: "},
      {"run s.toml --sed 1", "unknown option --sed; did you mean \"--seed\"?"},
      {"run --sed 1", "unknown option --sed; did you mean \"--seed\"?"},
      {"--json run s.toml", "unknown option --json; options follow the command"},
      {"run s.toml extra", "unexpected argument \"extra\""},
      {"run s.toml --seed", "--seed: a value is missing"},
      {"run s.toml --seed 1 --seed 2", "--seed: may be given only once"},
      {"run s.toml --seed x", "error: --seed: expected an integer between"},
      {"run s.toml --duration 1s --set duration=2", "is also given as --duration; give only one of the two"},
      {"run s.toml --set rig.coil[0].max_current=1", "has no [[rig.coil]]; add one for each"},
      {"run s.toml --set field.earth=[18]", "write --set 'field={type=\"NAME\", earth=[18]}'"},
      {"identify s.toml", "is a scenario; run it with `faba run`"},
      {"activity s.toml", "is a scenario; run it with `faba run`"},
      {"compare-controllers s.toml", "is a scenario; run it with `faba run`"},
      {"identify s.toml --shard 5/3", "--shard: \"5/3\" is out of range"},
      {"schema scenari", "kind: \"scenari\" is not one of scenario, rig"},
      {"field at s.toml", "--points FILE.csv"},
      {"rig simulate s.toml", "--at SOCKET"},
      {"compare a b --no-align --t0 1", "--t0 and --no-align cannot be combined; give only one of them"},
      {"run s.toml --set duration=-1",
       "duration: -1 (without a unit: s) is out of range; it must be between 0 s"},
      {"run s.toml --set duration='-1 ms'", "duration: -1 ms is out of range; it must be between 0 ms"},
      {"run s.toml --threads 2000", "--threads: expected an integer between 1 and 1024, got \"2000\""},
      {"run s.toml --threads x", "--threads: expected an integer between 1 and 1024, got \"x\""}};
  for (const auto& [arguments, message] : cases) {
    const Called c = faba_in(f.path, arguments);
    INFO("faba ", std::string(arguments), " -> ", c.err);
    CHECK(c.exit == 2);
    CHECK(c.err.find(message) != std::string::npos);
  }
}

TEST_CASE("invalid pictures: exit 3, nothing written") {
  const TestFolder f;
  write_file(f.path / "s.toml", kSmallScene);
  write_file(f.path / "empty.mp4", "");
  write_file(f.path / "text.tif", "this is not a picture");
  std::string pgm = "P5\n160 120\n255\n";
  write_file(f.path / "even.pgm", pgm + std::string(160 * 120, 'x'));
  write_file(f.path / "cut.pgm", pgm + std::string(100, 'x'));
  std::string line = pgm;
  for (int y = 0; y < 120; ++y)
    for (int x = 0; x < 160; ++x) line += char(2 * x + y < 200 ? 60 : 180);
  write_file(f.path / "line.pgm", line);
  std::filesystem::create_directory(f.path / "folder");
  for (const char* picture :
       {"none.tif", "folder", "empty.mp4", "text.tif", "even.pgm", "cut.pgm", "line.pgm"}) {
    for (const std::string& verb : {std::string("drop ") + picture + " --overlay o.png",
                                    std::string("run s.toml --out out --from-video ") + picture}) {
      const Called c = faba_in(f.path, verb);
      INFO(verb, " -> ", c.exit, " ", c.err);
      CHECK(c.exit == 3);
      CHECK(one_clear_line(c.err));
      CHECK(c.err.find(picture) != std::string::npos);
      CHECK_FALSE(std::filesystem::exists(f.path / "out"));
      CHECK_FALSE(std::filesystem::exists(f.path / "o.png"));
    }
  }
}

TEST_CASE("an output that cannot be written: exit 1, one line") {
  const TestFolder f;
  write_file(f.path / "s.toml", kSmallScene);
  const Called c = faba_in(f.path, "run s.toml --seed 1 --out /proc/nowhere/run");
  CHECK(c.exit == 1);
  CHECK(one_clear_line(c.err));
}

TEST_CASE("files that the program did not write are not overwritten, even with --force") {
  const TestFolder f;
  write_file(f.path / "s.toml", "duration = '1 s'\n[[swarm]]\ncount = 5\n");
  std::filesystem::create_directory(f.path / "thesis");
  write_file(f.path / "thesis/report.html", "mine");
  for (const char* force : {"", " --force"}) {
    const Called c = faba_in(f.path, std::string("run s.toml --seed 1 --out thesis") + force);
    CHECK(c.exit == 2);
    CHECK(c.err.find("has files that do not belong to a run") != std::string::npos);
  }
  CHECK(read_file(f.path / "thesis/report.html") == "mine");
  CHECK(faba_in(f.path, "run s.toml --seed 1 --out run --quiet").exit == 0);
  CHECK(faba_in(f.path, "run s.toml --seed 1 --out run --quiet").exit == 2);
  CHECK(faba_in(f.path, "run s.toml --seed 1 --out run --quiet --force").exit == 0);

  // A file with the name of an output is kept if the program did not write it; inputs of a run are not
  // replaced by it.
  std::filesystem::create_directory(f.path / "notes");
  write_file(f.path / "notes/incomplete", "buy milk\n");
  write_file(f.path / "notes/series.csv", "mine");
  CHECK(faba_in(f.path, "run s.toml --seed 1 --out notes --force").exit == 2);
  CHECK(read_file(f.path / "notes/series.csv") == "mine");
  CHECK(faba_in(f.path, "run run/scenario.toml --out run --force").exit == 2);
  CHECK(faba_in(f.path, "run run/scenario.toml --out run/../run --force").exit == 2);
  std::filesystem::copy_file(f.path / "s.toml", f.path / "run/picture.png");
  CHECK(faba_in(f.path, "run s.toml --from-video run/picture.png --out run --force").exit != 0);
  std::filesystem::remove(f.path / "run/video.mp4");
  std::filesystem::create_directory(f.path / "run/video.mp4");
  const std::string before = read_file(f.path / "run/series.csv");
  CHECK(faba_in(f.path, "run s.toml --seed 2 --out run --force").exit == 2);
  CHECK(read_file(f.path / "run/series.csv") == before);
  std::filesystem::create_symlink("nowhere", f.path / "dangling");
  CHECK(faba_in(f.path, "run s.toml --seed 1 --out dangling").exit == 2);

  write_file(f.path / "drop.png", "a picture");
  for (const char* overlay : {"drop.png", "./drop.png", "thesis", "edge.tif", "''"}) {
    const Called c = faba_in(f.path, std::string("drop drop.png --force --overlay ") + overlay);
    INFO(overlay, ": ", c.err);
    CHECK(c.exit == 2);
    CHECK(one_clear_line(c.err));
  }
  CHECK(read_file(f.path / "drop.png") == "a picture");
}

TEST_CASE("four parallel runs use four directories; errors give the exit code if stderr cannot be written") {
  const TestFolder f;
  write_file(f.path / "s.toml", "duration = '1 s'\n[[swarm]]\ncount = 5\n");
  const std::string run = std::string("'") + FABA_PROGRAM + "' run s.toml --seed 1 --quiet";
  const std::string all = "cd '" + f.path.string() + "' && for i in 1 2 3 4; do " + run + " & done; wait";
  CHECK(std::system(all.c_str()) == 0);
  for (const char* name : {"s-1", "s-1-2", "s-1-3", "s-1-4"}) {
    CHECK(std::filesystem::exists(f.path / "runs" / name / "report.html"));
    CHECK_FALSE(std::filesystem::exists(f.path / "runs" / name / "incomplete"));
  }
  for (const auto& [command, code] : {std::pair{"drop nofile 2>&-", 3}, {"run nofile 2>/dev/full", 2}}) {
    const int status = std::system((std::string("'") + FABA_PROGRAM + "' " + command).c_str());
    CHECK(WEXITSTATUS(status) == code);
  }
}

TEST_CASE("a signal stops a run within a frame of many steps, and a second signal has no effect") {
  const TestFolder f;
  // A small hot cell turns so fast that a frame has 1e8 steps.
  write_file(f.path / "slow.toml",
             "[[swarm]]\ncount = 50\nmodel = { type = 'dipole', temperature = 500, viscosity = 1e-5, radius "
             "= 1e-8 }\n");
  write_file(f.path / "stop.sh",
             std::string("'") + FABA_PROGRAM +
                 "' run slow.toml --seed 1 --out slow --duration '0.1 s' 2> err &\np=$!\n"
                 "until grep -q 'steps per frame' err || ! kill -0 $p; do sleep 0.1; done; sleep 0.5\n"
                 "kill -TERM $p\nkill -TERM $p\nwait $p\n");
  const auto began = std::chrono::steady_clock::now();
  const int status = std::system(("cd '" + f.path.string() + "' && sh stop.sh").c_str());
  CHECK(WEXITSTATUS(status) == 130);
  CHECK(std::chrono::steady_clock::now() - began < std::chrono::seconds(20));
  const std::string err = read_file(f.path / "err");
  INFO(err);
  CHECK(err.find("steps per frame") != std::string::npos);
  CHECK(err.find("interrupted") != std::string::npos);
  CHECK(std::filesystem::exists(f.path / "slow/incomplete"));
}

TEST_CASE("valid but probably unintended settings give a note of one line each") {
  const TestFolder f;
  struct Odd {
    const char* set;
    const char* message;
  };
  write_file(f.path / "s.toml", "duration = '0.5 s'\n[[swarm]]\ncount = 5\n[[swarm]]\ncount = 9\n");
  for (const Odd& o :
       {Odd{"reference.setpoint_px=[900,9]", "(900, 9) px is outside the box"},
        Odd{"limits.max_current=0", "there is no current in the coils"},
        Odd{"swarm[0].polarity=north",
            "swarm[0] is north-seeking, but the controller steers the south-seeking cells"},
        Odd{"duration=0", "has only one frame"},
        Odd{"exposure=100", "has no effect with motility = \"none\"; choose a motility law"},
        Odd{"swarm[0].model={type=\"dipole\",motile=0}", "swarm[0].model: motile is 0: no cell swims"},
        Odd{"camera.rate=20", ""}}) {
    const std::string type = std::string(o.set).starts_with("reference") ? " --set reference.type=hold" : "";
    const std::string run = "run s.toml --seed 1 --force --out run" + type + " --set '" + o.set + "'";
    const Called c = faba_in(f.path, run);
    INFO(o.set, ": ", c.err);
    CHECK(c.exit == 0);
    CHECK(c.err.find(o.message) != std::string::npos);
    CHECK(c.err.empty() == std::string(o.message).empty());
    CHECK(faba_in(f.path, run + " --quiet").err.empty());
  }
}
