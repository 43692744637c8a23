// Use of a bench: run, capture, step-response, jog, check and replay with the bench of `faba rig simulate`.
#include <fmt/format.h>

#include "tests/e2e/on_bench.h"

using namespace faba;

TEST_CASE(
    "a run on a bench cannot be resumed as a simulation, and an old run is kept if the device is not found") {
  OnBench b("", kPatient);
  if (!b.steer()) return;
  b.program->signal(SIGKILL);
  b.program->wait();
  const auto bytes = std::filesystem::file_size(b.f.path / "run/commands.csv");
  CHECK(read_file(b.f.path / "run/incomplete").find("cannot be resumed") != std::string::npos);
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

TEST_CASE("a second program cannot use a bench in use, and the first continues") {
  OnBench b("", kPatient);
  if (!b.steer()) return;
  const Called c = faba_in(b.f.path, "rig check scene.toml");
  CHECK(c.exit == 4);
  CHECK(c.err.find("another program") != std::string::npos);
  std::this_thread::sleep_for(std::chrono::milliseconds(200));
  CHECK(b.flows());
  b.program->signal(SIGINT);
  CHECK(b.program->wait() == 130);
  // A run that was interrupted is not complete.
  CHECK(std::filesystem::exists(b.f.path / "run/incomplete"));
  CHECK(read_file(b.f.path / "run/manifest.json").find("stopped by the user after") != std::string::npos);
}

TEST_CASE(
    "coils are disarmed by default: without --arm no device is opened, and the message asks for --arm") {
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

TEST_CASE(
    "a coil current that differs from the command is detected by the sensor, and the coils are switched "
    "off") {
  for (const char* fault : {"open", "weak"}) {
    INFO(fault);
    OnBench b(std::string("fault = '") + fault + "'\nfault_after = '3 s'\n", kPatient);
    if (!b.steer()) return;
    CHECK(b.program->wait() == 4);
    CHECK(b.err().find("differs from commanded current") != std::string::npos);
    CHECK_FALSE(b.flows());
  }
}

TEST_CASE("the device is disconnected: the run ends with one line, and the recording is kept") {
  OnBench b("", kPatient);
  if (!b.steer()) return;
  b.simulated->signal(SIGKILL);
  CHECK(b.program->wait() == 4);
  CHECK(one_clear_line(b.err()));
  // These coils no longer receive commands.
  CHECK(b.err().find("switch them off by hand") != std::string::npos);
  CHECK(std::filesystem::file_size(b.f.path / "run/series.csv") > 200);
  CHECK(read_file(b.f.path / "run/report.html").find("stopped by an error") != std::string::npos);
  // A bench can use the socket name of a bench that was killed, but not that of a running bench.
  b.simulated->wait();
  CHECK(std::filesystem::is_socket(b.f.path / "bench"));
  const Child next(b.f.path, "'" FABA_PROGRAM "' rig simulate scene.toml --at bench --quiet 2> next.txt");
  CHECK(soon([&] { return faba_in(b.f.path, "rig check scene.toml").exit == 0; }));
  const Called second = faba_in(b.f.path, "rig simulate scene.toml --at bench");
  CHECK(second.exit == 4);
  CHECK(one_clear_line(second.err));
  const Called nowhere = faba_in(b.f.path, "rig simulate scene.toml --at none/bench");
  CHECK(nowhere.exit == 4);
  CHECK(nowhere.err.find("folder none not found") != std::string::npos);
}

TEST_CASE("device not found: one clear line, exit 4, and no directory") {
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

TEST_CASE("capture without coils: numbered pictures, one of four, with their times") {
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

  // Playback of five pictures ends before the camera's delay is measured.
  const Called over = faba_in(b.f.path,
                              "rig check scene.toml --set \"rig.camera={ type = 'playback', file = "
                              "'pictures', fps = '60 Hz' }\"");
  CHECK(over.exit == 4);
  CHECK(one_clear_line(over.err));

  // Playback ends before the duration of the scene, which is reported in a note.
  const Called played = faba_in(b.f.path,
                                "rig run scene.toml --arm --json --out played --set rig.driver=none "
                                "--set \"rig.camera={ type = 'playback', file = 'a.avi', fast = true }\"");
  REQUIRE_MESSAGE(played.exit == 0, played.err);
  CHECK(played.err.find("the camera stopped after") != std::string::npos);
  const auto notes = played.json()["notes"];
  int stopped = 0;  // another note concerns the scale of the pictures, which is not known
  for (const auto& note : notes)
    stopped += note.get<std::string>().find("the camera stopped after") != std::string::npos;
  CHECK(stopped == 1);
  CHECK(played.json()["complete"] == true);
  // With the coils of a simulated bench that is started with the run.
  const Called coils = faba_in(b.f.path,
                               "rig run scene.toml --arm --json --out coils --set rig.driver=simulated "
                               "--set \"rig.camera={ type = 'playback', file = 'a.avi', fast = true }\"");
  REQUIRE_MESSAGE(coils.exit == 0, coils.err);
  CHECK(coils.json()["guard"]["commands"] > 0);
}

TEST_CASE(
    "a bench started with the run: the swarm reaches its setpoint, the recording is complete and replays "
    "identically") {
  test::works_in_real_time();
  const TestFolder f;
  const Called c = faba_in(f.path, "rig run '" FABA_SCENES
                                   "/bench.toml' --arm --seed 1 --duration '6 s' --json --out run "
                                   "--set record.lossless=true "
                                   "--set rig.guard.heartbeat_deadline=1 --set rig.guard.command_deadline=1 "
                                   "--set rig.camera_timeout=5");
  REQUIRE_MESSAGE(c.exit == 0, c.err);
  const auto j = c.json();
  // The initial distance is 280 px. The settling time depends on the load of this machine, so only the final
  // distance is checked. If more pictures are dropped than recorded, as with sanitizers, control is not
  // tested.
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
  // Runs of the previous version have another name for a column.
  std::string commands = read_file(f.path / "run/commands.csv");
  const auto column = commands.find("coils_off");
  REQUIRE(column != std::string::npos);
  std::string old = commands;
  std::ofstream(f.path / "run/commands.csv")
      << old.replace(column, std::string("coils_off").size(), "rested");
  CHECK(faba_in(f.path, "rig replay run --json").json()["same"] == true);
  // A command that differs in its last bit is detected.
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

TEST_CASE(
    "step responses on a schedule: gathered, reversed, recorded, and listed with their air exposure time") {
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
    CHECK(exposure > last + 0.9);  // at the start of the recording, after gathering
    last = exposure + 1;
    CHECK(r["frames"].get<int>() + r["frames_dropped"].get<int>() > 25);
    const auto dir = b.f.path / r["out"].get<std::string>();
    CHECK_FALSE(std::filesystem::exists(dir / "incomplete"));
    CHECK(std::filesystem::exists(dir / "report.html"));
    // The field is reversed at 0.3 s.
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

  // After an interrupt, complete recordings are listed in the study file; an incomplete one is not.
  Child stopped(b.f.path, "'" FABA_PROGRAM
                          "' rig step-response scene.toml --arm --repeat 50 --out other --quiet 2> err.txt");
  REQUIRE(soon([&] { return std::filesystem::exists(b.f.path / "other/study.toml"); }));
  stopped.signal(SIGINT);
  CHECK(stopped.wait() == 130);
  CHECK(one_clear_line(b.err()));
  CHECK_FALSE(b.flows());
}

TEST_CASE("rig jog with keys from a pipe: a key sets the current, and no current flows after the last key") {
  OnBench b("", kPatient);
  const Called c = faba_in(b.f.path, "rig jog scene.toml --step '0.1 A'", "printf 'a+++2-q' | ");
  REQUIRE_MESSAGE(c.exit == 0, c.err);
  CHECK(c.out.find(" select coils 0 to ") != std::string::npos);
  CHECK(c.out.find("coil 0: +0.300 A") != std::string::npos);
  CHECK(c.out.find("coil 1: -0.100 A") != std::string::npos);
  double most = 0;
  for (const Flowing& one : b.log()) most = std::max(most, one.most);
  CHECK(most == doctest::Approx(0.3).epsilon(0.01));
  CHECK_FALSE(b.flows());
  CHECK(faba_in(b.f.path, "rig check scene.toml").out.find("; the last frame arrived ") != std::string::npos);
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

TEST_CASE("the slew rate of currents is limited, in the control loop and with rig jog") {
  OnBench b("", kPatient);
  const std::string slow = " --set rig.guard.max_slew='2 A/s'";
  const Called keys = faba_in(b.f.path, "rig jog scene.toml --step '0.1 A'" + slow, "printf 'a+++   q' | ");
  CHECK_MESSAGE(keys.exit == 0, keys.err);
  const Called run = faba_in(b.f.path, "rig run scene.toml --arm --duration '1 s' --out slow --quiet" + slow);
  CHECK_MESSAGE(run.exit == 0, run.err);
  // 0.25 A take 0.125 s, up to about a frame less; without the limit they take 10 ms.
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
