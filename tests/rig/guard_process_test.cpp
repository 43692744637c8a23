// The guard's process with real drivers: a mock of NI-DAQmx, and the firmware behind a pseudo-terminal. Their
// logs record the outputs and times ("Safety" of docs/guide/bench.md).
#include "tests/rig/devices.h"

using namespace faba;

TEST_CASE("NI: voltages follow the wiring, channels of two devices, the enable line toggles while armed") {
  const StallMeter machine;
  NiDevice ni;
  GuardLink g(coils_on(ni.driver(), {"Dev1/ao0", "Dev1/ao1", "Dev2/ao0"}, {"Dev1/ai0", "Dev1/ai1"}),
              FABA_GUARD);
  CHECK(ni.last("Dev1/ao0") == kNeutral);  // not 0 V, which would be 0.5 A
  CHECK(ni.last("Dev2/ao0") == kNeutral);
  CHECK(ni.last_toggle() == 0);
  g.arm();
  steer(g, 0.3);
  CHECK(ni.last("Dev1/ao0") == doctest::Approx(kNeutral + 0.3 / 0.2));
  CHECK(ni.last("Dev2/ao0") == doctest::Approx(kNeutral + 0.3 / 0.2));
  if (!checked_in_time(monotonic_now() - ni.last_toggle(), 0.05, machine))
    test::skip("the machine stalled: the toggle period of the enable line was not checked");
  CHECK(g.report().sensed[0] == doctest::Approx(0.3));
  g.disarm();
  CHECK(ni.last("Dev1/ao0") == kNeutral);
  std::this_thread::sleep_for(std::chrono::milliseconds(50));
  CHECK(ni.last("Dev1/port0/line0") == 0);
}

TEST_CASE("NI: without an enable line the guard refuses to arm") {
  NiDevice ni;
  GuardLink g(coils_on(ni.driver(false), {"Dev1/ao0"}), FABA_GUARD);
  try {
    g.arm();
    FAIL("armed");
  } catch (const Error& e) {
    CHECK(e.code() == Errc::device);
    CHECK(std::string(e.what()).find("no enable line") != std::string::npos);
  }
  steer(g, 0.05);
  CHECK(ni.last("Dev1/ao0") == kNeutral);
}

TEST_CASE("the control thread hangs while the program runs: coils off after the command timeout") {
  until_in_time([] {
    Firmware f;
    GuardLink g(coils_on(f.driver(), {"0", "1"}, {"0", "1"}, false), FABA_GUARD);
    g.arm();
    steer(g, 0.2);
    CHECK(f.log().back().furthest == doctest::Approx(1.5));
    f.machine.begin();
    const double t = monotonic_now();
    if (!checked_in_time(f.rest_after(t), kWithin, f.machine)) return false;
    CHECK(g.report().fault == CoilGuard::Fault::command_timeout);
    return true;
  });
}

TEST_CASE("a control cycle that overruns: coils off without a fault, until clear_timeout()") {
  Firmware f;
  GuardLink g(coils_on(f.driver(), {"0", "1"}, {}, false), FABA_GUARD);
  g.deenergise_when_late();
  g.arm();
  steer(g, 0.2);
  const auto flows = [&] { return f.log().back().furthest > 1e-6; };
  REQUIRE(flows());
  CHECK(g.command_timeouts() == 0);
  REQUIRE(soon([&] { return !flows(); }, 5));
  CHECK(g.command_timeouts() == 1);
  CHECK(g.report().state == CoilGuard::State::armed);
  CHECK_FALSE(g.request(std::vector<double>(2, 0.3), monotonic_now()));  // from a frame before the timeout
  CHECK(g.clear_timeout());
  CHECK_FALSE(g.clear_timeout());
  CHECK(g.request(std::vector<double>(2, 0.3), monotonic_now()));
  CHECK(soon(flows, 5));
}

TEST_CASE("serial: the guard is killed or stopped: the board de-energises the coils by itself") {
  for (const int signal : {SIGKILL, SIGSTOP})
    until_in_time([signal] {
      Firmware f;
      GuardLink g(coils_on(f.driver(), {"0", "1"}), FABA_GUARD);
      g.arm();
      steer(g, 0.2);
      REQUIRE(f.log().back().enable == 1);
      f.machine.begin();
      const double t = monotonic_now();
      ::kill(g.process(), signal);
      const bool checked = checked_in_time(f.rest_after(t), kWithin, f.machine);
      CHECK(f.log().back().furthest < 1e-6);
      // The program detects it, and does not wait for ever for a guard that hangs.
      CHECK(soon([&] { return g.report().state == CoilGuard::State::tripped; }, 5));
      const std::string reason = g.report().reason.data();
      CHECK_MESSAGE(reason.find(signal == SIGKILL ? "has ended" : "does not respond") != std::string::npos,
                    reason);
      CHECK(g.report().write_ok == (signal == SIGKILL));
      CHECK_THROWS_AS(g.arm(), Error);
      return checked;
    });
}

TEST_CASE("serial: a board is unplugged or hangs: the guard trips and names the port") {
  for (const int signal : {SIGKILL, SIGSTOP}) {
    Firmware f;
    GuardLink g(coils_on(f.driver(), {"0"}), FABA_GUARD);
    g.arm();
    steer(g, 0.2);
    f.child->signal(signal);
    for (int i = 0; i < 20 && g.report().state != CoilGuard::State::tripped; ++i) steer(g, 0.02);
    const std::string reason = g.report().reason.data();
    CHECK_MESSAGE(reason.find("port") != std::string::npos, reason);
    CHECK_FALSE(g.report().write_ok);  // the state of these coils is unknown
  }
}

TEST_CASE("serial: after a fault and a reset the guard can be armed again, and a new client is accepted") {
  Firmware f;
  {
    GuardLink g(coils_on(f.driver(), {"0"}), FABA_GUARD);
    g.arm();
    steer(g, 0.1);
    steer(g, 0.05, 9);
    CHECK(g.report().fault == CoilGuard::Fault::over_current);
    CHECK_THROWS_AS(g.arm(), Error);
    g.reset();
    g.arm();
    steer(g, 0.1);
    CHECK(g.report().state == CoilGuard::State::armed);
    CHECK(f.log().back().furthest == doctest::Approx(1.5));
  }
  CHECK(f.log().back().enable == 0);
  GuardLink again(coils_on(f.driver(), {"0"}), FABA_GUARD);
  again.arm();
  steer(again, 0.1);
  CHECK(f.log().back().enable == 1);
}

TEST_CASE("serial: not a serial line, missing device") {
  CHECK_THROWS_AS(GuardLink(coils_on({{"type", "serial"}, {"port", "/dev/null"}}, {"0"}), FABA_GUARD), Error);
  CHECK_THROWS_AS(GuardLink(coils_on({{"type", "serial"}, {"port", "/nonexistent"}}, {"0"}), FABA_GUARD),
                  Error);
}
