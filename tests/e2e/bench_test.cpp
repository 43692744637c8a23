// The bench as a user has it: `faba rig run` against `faba rig simulate`, whose log says when current flowed.
// What may happen to a program happens to it here (H1, H2, H4 and H6 of docs/guide/bench.md).
#include <doctest/doctest.h>
#include <fmt/format.h>

#include <cmath>
#include <fstream>
#include <sstream>

#include "tests/e2e/program.h"
#include "tests/rig/devices.h"

using namespace faba;

namespace {

constexpr double kZero = 5e-3;   // A, a hundredth of full scale and four of a 12-bit output's steps of 1.2 mA
constexpr double kWithin = 0.1;  // s, H1

const std::string kScene =
    "duration = '20 s'\nseed = 1\ncamera = { rate = '30 Hz' }\n"
    "limits = { max_current = '0.4 A' }\n"
    "arena = { type = 'box', size_px = [160, 120] }\n"
    "controller = { type = 'manual', current = [0.3, -0.2] }\n"
    "[[swarm]]\ncount = 30\nmodel = { type = 'dipole', preset = 'IT-1' }\n";

const std::string kSimulatedCoils = "driver = { type = 'simulated', at = 'bench' }\n";

// Where deadlines of a tenth of a second are not what is tested: a busy machine may stand still for as long.
const std::string kPatient = "guard = { heartbeat_deadline = '1 s', command_deadline = '1 s' }\n";

struct Flowing {
  double t;     // s, monotonic
  double most;  // A, in any coil, or V beyond the voltage of none
};

std::vector<Flowing> read_log(const std::filesystem::path& csv) {
  std::vector<Flowing> all;
  std::ifstream in(csv);
  std::string line;
  std::getline(in, line);
  const auto columns = std::count(line.begin(), line.end(), ',') + 1;
  const auto coils = (columns - 3) / 2;
  while (std::getline(in, line)) {
    if (std::count(line.begin(), line.end(), ',') + 1 != columns) break;  // being written
    std::vector<double> v;
    std::stringstream words(line);
    for (std::string word; std::getline(words, word, ',');) v.push_back(std::stod(word));
    double most = 0;
    for (auto k = 3 + coils; k < columns; ++k) most = std::max(most, std::fabs(v[std::size_t(k)]));
    all.push_back({v[0], most});
  }
  return all;
}

// A simulated bench with its log, and a run on it that has begun.
struct OnBench {
  explicit OnBench(const std::string& bench = "", const std::string& more = "")
      : f(),
        rig("\n[rig]\ncamera = { type = 'simulated', at = 'bench' }\n" +
            (more.starts_with("driver") ? "" : kSimulatedCoils) + more + "[rig.bench]\n" + bench) {
    write_file(f.path / "scene.toml", kScene + rig);
    simulated = std::make_unique<Child>(
        f.path, "'" FABA_PROGRAM "' rig simulate scene.toml --at bench --log coils.csv --quiet 2> bench.txt");
    REQUIRE(soon([&] { return std::filesystem::exists(f.path / "bench"); }));
  }
  void run() {
    program = std::make_unique<Child>(
        f.path, "'" FABA_PROGRAM "' rig run scene.toml --arm --quiet --out run 2> err.txt");
  }
  std::vector<Flowing> log() const { return read_log(f.path / "coils.csv"); }
  bool flows() const {
    const auto l = log();
    return !l.empty() && l.back().most > 0.1;
  }
  // Seconds from `t` until the last moment when current flowed.
  double flowed_after(double t) const {
    REQUIRE(soon([&] { return !log().empty() && log().back().most < kZero; }, 5));
    double last = t;
    bool on = false;
    for (const Flowing& one : log()) {
      if (on && one.t > t) last = one.t;
      on = one.most >= kZero;
    }
    return last - t;
  }
  std::string err() const { return read_file(f.path / "err.txt"); }

  TestFolder f;
  std::string rig;
  std::unique_ptr<Child> simulated, program;
  StandStill machine;
};

// When the last current had gone, s.
double rest_of(const std::vector<Flowing>& all) {
  double t = 0;
  bool flowed = false;
  for (const Flowing& one : all) {
    if (flowed && one.most < 1e-6) t = one.t;
    flowed = one.most >= 1e-6;
  }
  return t;
}

}  // namespace

TEST_CASE("whatever ends or stops the program, no current flows 100 ms later") {
  for (const int signal : {SIGKILL, SIGSTOP, SIGTERM, SIGINT, SIGSEGV, SIGABRT}) {
    INFO("signal ", signal);
    OnBench b;
    b.run();
    REQUIRE(soon([&] { return b.flows(); }));
    std::this_thread::sleep_for(std::chrono::milliseconds(200));
    const double t = monotonic_now();
    b.program->signal(signal);
    const double after = b.flowed_after(t);
    CHECK(after < kWithin + b.machine.longest());
    if (signal == SIGTERM || signal == SIGINT) {
      CHECK(b.program->wait() == 130);
      CHECK(faba_in(b.f.path,
                    "run scene.toml --set camera.sensor=frames --duration '0.2 s' --quiet --out other")
                .exit == 0);  // the scene runs without a bench, too
      CHECK(std::filesystem::exists(b.f.path / "run/series.csv"));
    }
  }
}

TEST_CASE("the same with National Instruments' library, and with a board on a serial line") {
  // A camera is needed, and a driver that is not the simulated bench's.
  const auto on = [](const Json& driver, const std::vector<std::string>& channels) {
    std::string text = "driver = " + Json(driver).dump() + "\n";
    std::replace(text.begin(), text.end(), ':', '=');
    for (const std::string& c : channels)
      text +=
          "[[rig.coil]]\nchannel = '" + c + "'\ngain = '0.2 A/V'\nneutral = '2.5 V'\nmax_current = '0.4 A'\n";
    return text;
  };
  for (const int signal : {SIGKILL, SIGSTOP, SIGTERM}) {
    INFO("signal ", signal);
    const auto ends = [&](OnBench& b, const auto& flows, const auto& rest) {
      b.run();
      REQUIRE(soon(flows));
      std::this_thread::sleep_for(std::chrono::milliseconds(200));
      const double t = monotonic_now();
      b.program->signal(signal);
      REQUIRE(soon([&] { return !flows(); }, 5));
      std::this_thread::sleep_for(std::chrono::milliseconds(50));
      CHECK_FALSE(flows());
      CHECK(rest() - t < kWithin + b.machine.longest());
    };
    {
      const NiDevice ni;
      OnBench b("", on(ni.driver(), {"Dev1/ao0", "Dev1/ao1"}));
      ends(
          b, [&] { return std::fabs(ni.last("Dev1/ao0") - kNeutral) > 1e-6; },
          [&] {
            std::vector<Flowing> all;
            for (const auto& l : ni.log())
              if (l.channel == "Dev1/ao0") all.push_back({l.t, std::fabs(l.value - kNeutral)});
            return rest_of(all);
          });
    }
    {
      const Firmware board;
      OnBench b("", on(board.driver(), {"0", "1"}));
      ends(
          b, [&] { return !board.log().empty() && board.log().back().furthest > 1e-6; },
          [&] {
            std::vector<Flowing> all;
            for (const auto& l : board.log()) all.push_back({l.t, l.furthest});
            return rest_of(all);
          });
    }
  }
}

TEST_CASE("a program that was stopped and goes on finds the coils at rest, and says so") {
  OnBench b;
  b.run();
  REQUIRE(soon([&] { return b.flows(); }));
  b.program->signal(SIGSTOP);
  std::this_thread::sleep_for(std::chrono::milliseconds(300));
  b.program->signal(SIGCONT);
  CHECK(b.program->wait() == 4);
  CHECK(one_clear_line(b.err()));
  CHECK_MESSAGE(b.err().find("coil guard: ") != std::string::npos,
                b.err());  // no sign of life, or no fresh command
  std::this_thread::sleep_for(std::chrono::milliseconds(100));
  CHECK_FALSE(b.flows());
  CHECK(std::filesystem::exists(b.f.path / "run/incomplete"));  // what was recorded does not pass as whole
  CHECK(read_file(b.f.path / "run/coils.log").find("faulted ") != std::string::npos);
}

TEST_CASE("the guard itself is killed or stopped: the enable line lets no more current through") {
  for (const int signal : {SIGKILL, SIGSTOP}) {
    OnBench b;
    b.run();
    REQUIRE(soon([&] { return b.flows(); }));
    // Its only child: the bench was begun by the test.
    FILE* list = popen(("pgrep -P " + std::to_string(b.program->process())).c_str(), "r");
    int guard = 0;
    REQUIRE(std::fscanf(list, "%d", &guard) == 1);
    pclose(list);
    const double t = monotonic_now();
    ::kill(guard, signal);
    CHECK(b.flowed_after(t) < kWithin + b.machine.longest());
    if (signal == SIGSTOP) ::kill(guard, SIGCONT);
    CHECK(b.program->wait() == 4);
    CHECK(one_clear_line(b.err()));
  }
}

TEST_CASE(
    "a camera that hangs: no current after the larger of 100 ms and two frames, and an end that says so") {
  OnBench b("freeze_after = 1.5\n", "guard = { heartbeat_deadline = '1 s' }\n");
  b.run();
  REQUIRE(soon([&] { return b.flows(); }));
  CHECK(b.program->wait() == 4);
  CHECK(b.err().find("has given no frame for 2 s") != std::string::npos);
  // The log begins with the bench, whose camera hangs 1.5 s later.
  double last = 0;
  for (const Flowing& one : b.log())
    if (one.most >= kZero) last = one.t;
  const double began = b.log().front().t;
  CHECK(last - began > 0.5);
  CHECK(last - began < 1.5 + kWithin + b.machine.longest());
}

TEST_CASE(
    "a run on a bench is not gone on with as a simulation, and an old one stays when no device is there") {
  OnBench b("", kPatient);
  b.run();
  REQUIRE(soon([&] { return b.flows(); }));
  b.program->signal(SIGKILL);
  b.program->wait();
  const auto bytes = std::filesystem::file_size(b.f.path / "run/commands.csv");
  CHECK(read_file(b.f.path / "run/incomplete").find("resume") == std::string::npos);
  const Called c = faba_in(b.f.path, "resume run");
  CHECK(c.exit == 2);
  CHECK(one_clear_line(c.err));
  CHECK(std::filesystem::file_size(b.f.path / "run/commands.csv") == bytes);
  CHECK(faba_in(b.f.path, "rig step-response scene.toml --arm --out new --set rig.driver.at=nowhere").exit ==
        4);
  CHECK_FALSE(std::filesystem::exists(b.f.path / "new"));
  CHECK(faba_in(b.f.path, "rig run scene.toml --arm --force --out run --set rig.driver.at=nowhere").exit ==
        4);
  CHECK(std::filesystem::file_size(b.f.path / "run/commands.csv") == bytes);
}

TEST_CASE("who comes second to a bench is turned away, and the first goes on") {
  OnBench b("", kPatient);
  b.run();
  REQUIRE(soon([&] { return b.flows(); }));
  const Called c = faba_in(b.f.path, "rig check scene.toml");
  CHECK(c.exit == 4);
  CHECK(c.err.find("another program") != std::string::npos);
  std::this_thread::sleep_for(std::chrono::milliseconds(200));
  CHECK(b.flows());
  b.program->signal(SIGINT);
  CHECK(b.program->wait() == 130);
}

TEST_CASE("coils begin disarmed: without --arm nothing is opened, and --arm is what it asks for") {
  OnBench b;
  const Called c = faba_in(b.f.path, "rig run scene.toml --out run");
  CHECK(c.exit == 2);
  CHECK(one_clear_line(c.err));
  CHECK(c.err.find("--arm") != std::string::npos);
  CHECK_FALSE(std::filesystem::exists(b.f.path / "run"));
  for (const Flowing& one : b.log()) CHECK(one.most < kZero);
}

TEST_CASE("a bench without an enable line is not armed") {
  OnBench b("enable_line = false\n");
  b.run();
  CHECK(b.program->wait() == 4);
  CHECK(b.err().find("enable line") != std::string::npos);
  for (const Flowing& one : b.log()) CHECK(one.most < kZero);
}

TEST_CASE("a coil that does not get what was asked for: the sensed current says so, and all goes to rest") {
  for (const char* fault : {"open", "weak"}) {
    INFO(fault);
    OnBench b(std::string("fault = '") + fault + "'\nfault_after = '1 s'\n", kPatient);
    b.run();
    REQUIRE(soon([&] { return b.flows(); }));
    CHECK(b.program->wait() == 4);
    CHECK(b.err().find("is not what was asked for") != std::string::npos);
    CHECK_FALSE(b.flows());
  }
}

TEST_CASE("the device is unplugged: the run ends with one line, and what was recorded is kept") {
  OnBench b("", kPatient);
  b.run();
  REQUIRE(soon([&] { return b.flows(); }));
  b.simulated->signal(SIGKILL);
  CHECK(b.program->wait() == 4);
  CHECK(one_clear_line(b.err()));
  CHECK(std::filesystem::file_size(b.f.path / "run/series.csv") > 200);
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
  CHECK(faba_in(b.f.path, "rig capture scene.toml --frames 3 --out a.avi --quiet").exit == 0);
  CHECK(faba_in(b.f.path, "track a.avi --json").exit == 0);
  for (const Flowing& one : b.log()) CHECK(one.most < kZero);
}

TEST_CASE(
    "a bench of its own: the swarm comes to its setpoint, and the recording is whole and decided again") {
  const TestFolder f;
  const Called c = faba_in(f.path, "rig run '" FABA_SCENES
                                   "/bench.toml' --arm --seed 1 --duration '6 s' --json --out run "
                                   "--set record.lossless=true "
                                   "--set rig.guard.heartbeat_deadline=1 --set rig.guard.command_deadline=1");
  REQUIRE_MESSAGE(c.exit == 0, c.err);
  const auto j = c.json();
  // It began 280 px away. How fast it comes depends on how busy this machine is, so that only that it comes
  // counts.
  CHECK(j["steady_rms_px"].get<double>() < 70);
  CHECK(j["complete"] == true);
  CHECK(j["guard"]["refused"] == 0);
  CHECK(j["frames"].get<int>() + j["frames_dropped"].get<int>() > 300);
  CHECK_FALSE(std::filesystem::exists(f.path / "run/incomplete"));
  CHECK(read_file(f.path / "run/report.html").find("Latency") != std::string::npos);

  const Called again = faba_in(f.path, "rig replay run --json");
  REQUIRE_MESSAGE(again.exit == 0, again.err);
  CHECK(again.json()["same"] == true);
  CHECK(again.json()["equal"] == j["frames"]);
  // A command that is another by its last bit is seen.
  std::string commands = read_file(f.path / "run/commands.csv");
  const auto line = commands.find("\n100,");
  const auto end = commands.find('\n', line + 1), last = commands.rfind(',', end) + 1;
  const double now = std::stod(commands.substr(last, end - last));
  commands.replace(last, end - last, fmt::format("{}", std::nextafter(now, 1)));
  std::ofstream(f.path / "run/commands.csv") << commands;
  const Called other = faba_in(f.path, "rig replay run --json");
  CHECK(other.exit == 1);
  CHECK(other.json()["first_other"] == 100);

  CHECK(faba_in(f.path, "rig replay nowhere").exit == 3);
}

TEST_CASE("step responses on a schedule: gathered, reversed, recorded, and listed with their time in air") {
  OnBench b("", kPatient +
                    "step_response = { gather = '1 s', before = '0.3 s', record = '0.7 s', field = '100 uT', "
                    "repeat = 2, every = '0 s' }\n");
  const Called refused = faba_in(b.f.path, "rig step-response scene.toml --out study");
  CHECK(refused.exit == 2);
  CHECK(one_clear_line(refused.err));
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
  CHECK(faba_in(b.f.path, "rig step-response scene.toml --arm --repeat 1 --out study --quiet").exit == 0);
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
}
