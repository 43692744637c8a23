// What a user does with a bench: run, capture, step-response, jog, check and replay against `faba rig
// simulate`.
#include <fmt/format.h>

#include "tests/e2e/on_bench.h"

using namespace faba;

TEST_CASE(
    "a run on a bench is not gone on with as a simulation, and an old one stays when no device is there") {
  OnBench b("", kPatient);
  if (!b.steer()) return;
  b.program->signal(SIGKILL);
  b.program->wait();
  const auto bytes = std::filesystem::file_size(b.f.path / "run/commands.csv");
  CHECK(read_file(b.f.path / "run/incomplete").find("resume") == std::string::npos);
  const Called c = faba_in(b.f.path, "resume run");
  CHECK(c.exit == 2);
  CHECK(one_clear_line(c.err));
  CHECK(std::filesystem::file_size(b.f.path / "run/commands.csv") == bytes);
  CHECK(faba_in(b.f.path,
                "rig step-response scene.toml --arm --out new --set rig.driver.at=nowhere "
                "--set rig.step_response.field='100 uT'")
            .exit == 4);
  CHECK_FALSE(std::filesystem::exists(b.f.path / "new"));
  CHECK(faba_in(b.f.path, "rig run scene.toml --arm --force --out run --set rig.driver.at=nowhere").exit ==
        4);
  CHECK(std::filesystem::file_size(b.f.path / "run/commands.csv") == bytes);
}

TEST_CASE("who comes second to a bench is turned away, and the first goes on") {
  OnBench b("", kPatient);
  if (!b.steer()) return;
  const Called c = faba_in(b.f.path, "rig check scene.toml");
  CHECK(c.exit == 4);
  CHECK(c.err.find("another program") != std::string::npos);
  std::this_thread::sleep_for(std::chrono::milliseconds(200));
  CHECK(b.flows());
  b.program->signal(SIGINT);
  CHECK(b.program->wait() == 130);
  // What was ended by hand does not pass as whole.
  CHECK(std::filesystem::exists(b.f.path / "run/incomplete"));
  CHECK(read_file(b.f.path / "run/manifest.json").find("stopped by the user after") != std::string::npos);
}

TEST_CASE("coils begin disarmed: without --arm nothing is opened, and --arm is what it asks for") {
  OnBench b;
  const Called c = faba_in(b.f.path, "rig run scene.toml --out run");
  CHECK(c.exit == 2);
  CHECK(one_clear_line(c.err));
  CHECK(c.err.find("--arm") != std::string::npos);
  CHECK_FALSE(std::filesystem::exists(b.f.path / "run"));
  for (const Flowing& one : b.log()) CHECK(one.most < kZero);
  const Called log = faba_in(b.f.path, "rig simulate scene.toml --at other --log coils.csv");
  CHECK(log.exit == 2);
  CHECK(one_clear_line(log.err));
}

TEST_CASE("a bench without an enable line is not armed") {
  OnBench b("enable_line = false\n");
  b.run();
  CHECK(b.program->wait() == 4);
  CHECK(b.err().find("enable line") != std::string::npos);
  CHECK(faba_in(b.f.path, "rig check scene.toml --json").exit == 4);
  for (const Flowing& one : b.log()) CHECK(one.most < kZero);
}

TEST_CASE("a coil that does not get what was asked for: the sensed current says so, and all goes to rest") {
  for (const char* fault : {"open", "weak"}) {
    INFO(fault);
    OnBench b(std::string("fault = '") + fault + "'\nfault_after = '1 s'\n", kPatient);
    if (!b.steer()) return;
    CHECK(b.program->wait() == 4);
    CHECK(b.err().find("differs from commanded current") != std::string::npos);
    CHECK_FALSE(b.flows());
  }
}

TEST_CASE("the device is unplugged: the run ends with one line, and what was recorded is kept") {
  OnBench b("", kPatient);
  if (!b.steer()) return;
  b.simulated->signal(SIGKILL);
  CHECK(b.program->wait() == 4);
  CHECK(one_clear_line(b.err()));
  // Nobody can tell such coils anything any more.
  CHECK(b.err().find("switch them off by hand") != std::string::npos);
  CHECK(std::filesystem::file_size(b.f.path / "run/series.csv") > 200);
  CHECK(read_file(b.f.path / "run/report.html").find("stopped by an error") != std::string::npos);
  // The name that the killed one has left is not in the next one's way, and one that is there is not
  // replaced.
  b.simulated->wait();
  CHECK(std::filesystem::is_socket(b.f.path / "bench"));
  const Child next(b.f.path, "'" FABA_PROGRAM "' rig simulate scene.toml --at bench --quiet 2> next.txt");
  CHECK(soon([&] { return faba_in(b.f.path, "rig check scene.toml").exit == 0; }));
  const Called second = faba_in(b.f.path, "rig simulate scene.toml --at bench");
  CHECK(second.exit == 4);
  CHECK(one_clear_line(second.err));
}

TEST_CASE("nothing there: one clear line, exit 4, and no directory") {
  const TestFolder f;
  write_file(f.path / "scene.toml", kScene +
                                        "\n[rig]\ncamera = { type = 'simulated', at = 'nowhere' }\ndriver = "
                                        "{ type = 'simulated', at = 'nowhere' }\n");
  const Called c = faba_in(f.path, "rig run scene.toml --arm --out run");
  CHECK(c.exit == 4);
  CHECK(one_clear_line(c.err));
  CHECK_FALSE(std::filesystem::exists(f.path / "run"));
  write_file(f.path / "plain.toml", kScene);
  const Called plain = faba_in(f.path, "rig run plain.toml --arm --out run");
  CHECK(plain.exit == 2);
  CHECK(plain.err.find("[rig]") != std::string::npos);
}

TEST_CASE("the camera alone is recorded: numbered pictures, one of four, with their times") {
  OnBench b;
  const Called c =
      faba_in(b.f.path, "rig capture scene.toml --frames 20 --one-of 4 --format pgm --out pictures --json");
  REQUIRE_MESSAGE(c.exit == 0, c.err);
  CHECK(c.json()["kept"] == 5);
  CHECK(std::filesystem::exists(b.f.path / "pictures/frame-000004.pgm"));
  CHECK(faba_in(b.f.path, "rig capture scene.toml --frames 3 --format pgm --out pictures").exit == 2);
  CHECK(faba_in(b.f.path, "rig capture scene.toml --for '3 m' --out a.avi").exit == 2);
  CHECK(faba_in(b.f.path, "rig capture scene.toml --for 0.1 --out a.avi --quiet").exit == 0);
  CHECK(faba_in(b.f.path, "track a.avi --json").exit == 0);
  for (const Flowing& one : b.log()) CHECK(one.most < kZero);

  // Five pictures are played in less time than a look at the camera's delay takes.
  const Called over = faba_in(b.f.path,
                              "rig check scene.toml --set \"rig.camera={ type = 'playback', file = "
                              "'pictures', fps = '60 Hz' }\"");
  CHECK(over.exit == 4);
  CHECK(one_clear_line(over.err));

  // Played as a camera it ends before the scene does, which is said.
  const Called played = faba_in(b.f.path,
                                "rig run scene.toml --arm --json --out played --set rig.driver=none "
                                "--set \"rig.camera={ type = 'playback', file = 'a.avi', fast = true }\"");
  REQUIRE_MESSAGE(played.exit == 0, played.err);
  CHECK(played.err.find("the camera stopped after") != std::string::npos);
  CHECK(played.json()["notes"].size() == 1);
  CHECK(played.json()["complete"] == true);
  // With coils of a bench that is begun with the run.
  const Called coils = faba_in(b.f.path,
                               "rig run scene.toml --arm --json --out coils --set rig.driver=simulated "
                               "--set \"rig.camera={ type = 'playback', file = 'a.avi', fast = true }\"");
  REQUIRE_MESSAGE(coils.exit == 0, coils.err);
  CHECK(coils.json()["guard"]["commands"] > 0);
}

TEST_CASE(
    "a bench of its own: the swarm comes to its setpoint, and the recording is whole and decided again") {
  const TestFolder f;
  const Called c = faba_in(f.path, "rig run '" FABA_SCENES
                                   "/bench.toml' --arm --seed 1 --duration '6 s' --json --out run "
                                   "--set record.lossless=true "
                                   "--set rig.guard.heartbeat_deadline=1 --set rig.guard.command_deadline=1 "
                                   "--set rig.camera_timeout=5");
  REQUIRE_MESSAGE(c.exit == 0, c.err);
  const auto j = c.json();
  // It began 280 px away. How fast it comes depends on how busy this machine is, so that only that it comes
  // counts. Where more pictures are missed than recorded, as with sanitizers, control was not tested.
  if (j["frames"] > j["frames_dropped"])
    CHECK(j["steady_rms_px"].get<double>() < 70);
  else
    test::skip("control was not checked: the machine lost more frames than it recorded");
  CHECK(j["complete"] == true);
  CHECK(j["guard"]["refused"] == 0);
  CHECK(j["frames"].get<int>() + j["frames_dropped"].get<int>() > 300);
  CHECK_FALSE(std::filesystem::exists(f.path / "run/incomplete"));
  CHECK(read_file(f.path / "run/report.html").find("Latency") != std::string::npos);

  const Called again = faba_in(f.path, "rig replay run --json");
  REQUIRE_MESSAGE(again.exit == 0, again.err);
  CHECK(again.json()["same"] == true);
  CHECK(again.json()["equal_commands"] == j["frames"]);
  // A run of the version before has another name for a column.
  std::string commands = read_file(f.path / "run/commands.csv");
  const auto column = commands.find("coils_off");
  REQUIRE(column != std::string::npos);
  std::string old = commands;
  std::ofstream(f.path / "run/commands.csv")
      << old.replace(column, std::string("coils_off").size(), "rested");
  CHECK(faba_in(f.path, "rig replay run --json").json()["same"] == true);
  // A command that is another by its last bit is seen.
  const auto line = commands.find("\n30,");
  const auto end = commands.find('\n', line + 1), last = commands.rfind(',', end) + 1;
  const double now = std::stod(commands.substr(last, end - last));
  commands.replace(last, end - last, fmt::format("{}", std::nextafter(now, 1)));
  std::ofstream(f.path / "run/commands.csv") << commands;
  const Called other = faba_in(f.path, "rig replay run --json");
  CHECK(other.exit == 1);
  CHECK(other.json()["first_difference"] == 30);
  std::ofstream(f.path / "run/commands.csv") << commands.replace(line, 4, "\n31,");
  CHECK(faba_in(f.path, "rig replay run").exit == 3);

  CHECK(faba_in(f.path, "rig replay nowhere").exit == 3);
}

TEST_CASE("step responses on a schedule: gathered, reversed, recorded, and listed with their time in air") {
  OnBench b("", kPatient +
                    "step_response = { gather = '1 s', before = '0.3 s', record = '0.7 s', field = '100 uT', "
                    "repeat = 2, every = '0 s' }\n");
  const Called refused = faba_in(b.f.path, "rig step-response scene.toml --out study");
  CHECK(refused.exit == 2);
  CHECK(one_clear_line(refused.err));
  for (const char* no : {"--out new --set rig.step_response.field='50 mT'", "--out run"}) {
    std::filesystem::create_directory(b.f.path / "run");
    std::ofstream(b.f.path / "run/scenario.toml") << "seed = 1\n";
    const Called other = faba_in(b.f.path, std::string("rig step-response scene.toml --arm ") + no);
    CHECK(other.exit == 2);
    CHECK(one_clear_line(other.err));
  }
  CHECK_FALSE(std::filesystem::exists(b.f.path / "new"));
  CHECK_FALSE(std::filesystem::exists(b.f.path / "study"));
  const Called c =
      faba_in(b.f.path, "rig step-response scene.toml --arm --exposure '90 s' --out study --json");
  REQUIRE_MESSAGE(c.exit == 0, c.err);
  const auto responses = c.json()["responses"];
  REQUIRE(responses.size() == 2);
  double last = 90;
  for (const auto& r : responses) {
    const double exposure = r["exposure_s"];
    CHECK(exposure > last + 0.9);  // at the beginning of the recording, a gathering later
    last = exposure + 1;
    CHECK(r["frames"].get<int>() + r["frames_dropped"].get<int>() > 25);
    const auto dir = b.f.path / r["out"].get<std::string>();
    CHECK_FALSE(std::filesystem::exists(dir / "incomplete"));
    CHECK(std::filesystem::exists(dir / "report.html"));
    // The field points one way until 0.3 s, and the other way afterwards.
    std::ifstream in(dir / "commands.csv");
    std::string line;
    std::getline(in, line);
    while (std::getline(in, line)) {
      std::vector<double> v;
      std::stringstream words(line);
      for (std::string word; std::getline(words, word, ',');) v.push_back(std::stod(word));
      if (std::fabs(v[2] - 0.3) > 0.04) CHECK(std::signbit(v[5]) == (v[2] > 0.3));  // a frame
    }
  }
  const Called more = faba_in(b.f.path, "rig step-response scene.toml --arm --repeat 1 --out study --quiet");
  CHECK_MESSAGE(more.exit == 0, more.err);
  const std::string study = read_file(b.f.path / "study/study.toml");
  CHECK(study.find("experiment = \"1\"") != std::string::npos);
  CHECK(study.find("experiment = \"2\"") != std::string::npos);
  const Called activity = faba_in(b.f.path, "activity study/study.toml --json");
  REQUIRE_MESSAGE(activity.exit == 0, activity.err);
  CHECK(activity.json()["videos"].size() == 3);
  CHECK(activity.json()["videos"][0]["direction_deg"] == 0);

  // Asked to stop: what was recorded is whole and listed, what was not is neither.
  Child stopped(b.f.path, "'" FABA_PROGRAM
                          "' rig step-response scene.toml --arm --repeat 50 --out other --quiet 2> err.txt");
  REQUIRE(soon([&] { return std::filesystem::exists(b.f.path / "other/study.toml"); }));
  stopped.signal(SIGINT);
  CHECK(stopped.wait() == 130);
  CHECK(one_clear_line(b.err()));
  CHECK_FALSE(b.flows());
}

TEST_CASE("currents by hand, from keys in a pipe: what a key says flows, and nothing after the last") {
  OnBench b("", kPatient);
  const Called c = faba_in(b.f.path, "rig jog scene.toml --step '0.1 A'", "printf 'a+++2-q' | ");
  REQUIRE_MESSAGE(c.exit == 0, c.err);
  CHECK(c.out.find("coil 0: +0.300 A") != std::string::npos);
  CHECK(c.out.find("coil 1: -0.100 A") != std::string::npos);
  double most = 0;
  for (const Flowing& one : b.log()) most = std::max(most, one.most);
  CHECK(most == doctest::Approx(0.3).epsilon(0.01));
  CHECK_FALSE(b.flows());
  const Called check = faba_in(b.f.path, "rig check scene.toml --json");
  REQUIRE_MESSAGE(check.exit == 0, check.err);
  CHECK(check.json()["guard"] == "disarmed");
  CHECK(check.json()["frames"].get<int>() > 20);
  CHECK(check.json()["cannot_arm"].is_null());
  CHECK(faba_in(b.f.path, "rig jog scene.toml --step '3 m'").exit == 2);
  CHECK(faba_in(b.f.path, "rig jog scene.toml --step 20").exit == 2);
  const Called none = faba_in(b.f.path, "rig jog '" FABA_SCENES "/steer.toml'");
  CHECK(none.exit == 2);
  CHECK(one_clear_line(none.err));
}

TEST_CASE("currents that may change but slowly: the loop keeps to it, and so do keys") {
  OnBench b("", kPatient);
  const std::string slow = " --set rig.guard.max_slew='2 A/s'";
  const Called keys = faba_in(b.f.path, "rig jog scene.toml --step '0.1 A'" + slow, "printf 'a+++   q' | ");
  CHECK_MESSAGE(keys.exit == 0, keys.err);
  const Called run = faba_in(b.f.path, "rig run scene.toml --arm --duration '1 s' --out slow --quiet" + slow);
  CHECK_MESSAGE(run.exit == 0, run.err);
  // 0.25 A take 0.125 s, less a frame and its like: without the limit they take 10 ms.
  double none_until = 0;
  int rises = 0;
  bool below = true;
  for (const Flowing& one : b.log()) {
    if (one.most < kZero) {
      none_until = one.t;
      below = true;
    }
    if (one.most > 0.25 && below) {
      CHECK(one.t - none_until > 0.08);
      below = false;
      ++rises;
    }
  }
  CHECK(rises == 2);
}
