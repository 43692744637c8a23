// Safety of the bench ("Safety" in docs/guide/bench.md): `faba rig run` with the bench of `faba rig
// simulate`, whose log has the currents. Processes are killed and stopped; tests check when the coils are
// off.
#include "tests/e2e/on_bench.h"

using namespace faba;

namespace {

// Time at which the last current ended, s.
double off_time(const std::vector<Flowing>& all) {
  double t = 0;
  bool flowed = false;
  for (const Flowing& one : all) {
    if (flowed && one.most < 1e-6) t = one.t;
    flowed = one.most >= 1e-6;
  }
  return t;
}

}  // namespace

TEST_CASE("no current flows 100 ms after the program is killed or stopped by any signal") {
  for (const int signal : {SIGKILL, SIGSTOP, SIGTERM, SIGINT, SIGSEGV, SIGABRT})
    until_in_time([signal] {
      INFO("signal ", signal);
      OnBench b;
      if (!b.steer()) return true;
      b.machine.begin();
      const double t = monotonic_now();
      b.program->signal(signal);
      if (!checked_in_time(b.flowed_after(t), kWithin, b.machine)) return false;
      if (signal != SIGTERM && signal != SIGINT) return true;
      const int exit = b.program->wait();
      if (exit == 4 && b.was_kept_waiting()) return false;  // the guard tripped before the signal
      CHECK(exit == 130);
      CHECK(faba_in(b.f.path,
                    "run scene.toml --set camera.sensor=frames --duration '0.2 s' --quiet --out other")
                .exit == 0);  // the scene also runs without a bench
      CHECK(std::filesystem::exists(b.f.path / "run/series.csv"));
      return true;
    });
}

TEST_CASE("no current flows 100 ms after the program is killed or stopped: NI-DAQmx and serial board") {
  // The camera is that of the simulated bench, the driver is another.
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
    const auto ends = [&](OnBench& b, const auto& flows, const auto& last_current) {
      if (!b.steer(flows)) return true;
      b.machine.begin();
      const double t = monotonic_now();
      b.program->signal(signal);
      REQUIRE(soon([&] { return !flows(); }, 5));
      std::this_thread::sleep_for(std::chrono::milliseconds(50));
      CHECK_FALSE(flows());
      return checked_in_time(last_current() - t, kWithin, b.machine);
    };
    until_in_time([&] {
      const NiDevice ni;
      OnBench b("", on(ni.driver(), {"Dev1/ao0", "Dev1/ao1"}));
      return ends(
          b, [&] { return std::fabs(ni.last("Dev1/ao0") - kNeutral) > 1e-6; },
          [&] {
            std::vector<Flowing> all;
            for (const auto& l : ni.log())
              if (l.channel == "Dev1/ao0") all.push_back({l.t, std::fabs(l.value - kNeutral)});
            return off_time(all);
          });
    });
    until_in_time([&] {
      const Firmware board;
      OnBench b("", on(board.driver(), {"0", "1"}));
      return ends(
          b, [&] { return !board.log().empty() && board.log().back().furthest > 1e-6; },
          [&] {
            std::vector<Flowing> all;
            for (const auto& l : board.log()) all.push_back({l.t, l.furthest});
            return off_time(all);
          });
    });
  }
}

TEST_CASE("a program that is stopped and continued finds the coils off, and ends with an error") {
  OnBench b;
  if (!b.steer()) return;
  b.program->signal(SIGSTOP);
  std::this_thread::sleep_for(std::chrono::milliseconds(300));
  b.program->signal(SIGCONT);
  CHECK(b.program->wait() == 4);
  CHECK(one_clear_line(b.err()));
  CHECK_MESSAGE(b.err().find("coil guard: ") != std::string::npos,
                b.err());  // heartbeat timeout or command timeout
  std::this_thread::sleep_for(std::chrono::milliseconds(100));
  CHECK_FALSE(b.flows());
  CHECK(std::filesystem::exists(b.f.path / "run/incomplete"));
  CHECK(read_file(b.f.path / "run/coils.log").find("tripped ") != std::string::npos);
}

TEST_CASE("the guard is killed or stopped: the enable line switches the currents off") {
  for (const int signal : {SIGKILL, SIGSTOP})
    until_in_time([signal] {
      OnBench b;
      if (!b.steer()) return true;
      // The guard is the only child of the program: the bench was started by the test.
      FILE* list = popen(("pgrep -P " + std::to_string(b.program->process())).c_str(), "r");
      int guard = 0;
      REQUIRE(std::fscanf(list, "%d", &guard) == 1);
      pclose(list);
      b.machine.begin();
      const double t = monotonic_now();
      ::kill(guard, signal);
      const bool checked = checked_in_time(b.flowed_after(t), kWithin, b.machine);
      if (signal == SIGSTOP) ::kill(guard, SIGCONT);
      CHECK(b.program->wait() == 4);
      CHECK(one_clear_line(b.err()));
      return checked;
    });
}

TEST_CASE("a camera that hangs: no current after the larger of 100 ms and two frames, and an error message") {
  until_in_time([] {
    OnBench b("freeze_after = 3\n", "guard = { heartbeat_deadline = '1 s' }\n");
    if (!b.steer()) return true;
    b.machine.begin();
    CHECK(b.program->wait() == 4);
    // The log starts with the bench; its camera hangs 3 s later.
    double last = 0;
    for (const Flowing& one : b.log())
      if (one.most >= kZero) last = one.t;
    const double began = b.log().front().t;
    if (!checked_in_time(last - began, 3 + kWithin, b.machine)) return false;
    if (b.was_kept_waiting()) return false;  // the guard tripped first because the machine was busy
    CHECK(last - began > 0.5);
    CHECK_MESSAGE(b.err().find("no picture for 2 s") != std::string::npos, b.err(), b.machine.longest());
    return true;
  });
}
