// Errors of the mock of NI-DAQmx, and the reaction of the guard's process.
#include "tests/rig/devices.h"

using namespace faba;

TEST_CASE(
    "NI: after an error at call k, for every k, the enable line is dropped and the error text is reported") {
  for (int k = 1; k <= 40; k += k < 12 ? 1 : 7) {
    INFO("call ", k);
    NiDevice ni(k);
    std::string reason;
    try {
      GuardLink g(coils_on(ni.driver(), {"Dev1/ao0"}, {"Dev1/ai0"}), FABA_GUARD);
      g.arm();
      steer(g, 0.4);
      reason = g.report().reason.data();
      CHECK(g.report().state == CoilGuard::State::tripped);
    } catch (const Error& e) {
      CHECK(e.code() == Errc::device);
      reason = e.what();
    }
    CHECK(reason.find("-200324") != std::string::npos);
    CHECK(reason.find('\n') == std::string::npos);
    const double t = ni.last_toggle();
    std::this_thread::sleep_for(std::chrono::milliseconds(30));
    CHECK(ni.last_toggle() == t);
  }
}

TEST_CASE("NI: missing library, unknown device") {
  NiDevice ni;
  for (const auto& [driver, channel, reason] :
       {std::tuple<Json, std::string, std::string>{
            {{"type", "nidaqmx"}, {"library", "libnone.so"}}, "Dev1/ao0", "install"},
        {ni.driver(), "Dev9/ao0", "invalid"},
        {ni.driver(), "ao0", "invalid"}}) {
    std::string what;
    try {
      const GuardLink g(coils_on(driver, {channel}), FABA_GUARD);
    } catch (const Error& e) {
      CHECK(e.code() == Errc::device);
      what = e.what();
    }
    CHECK_MESSAGE(what.find(reason) != std::string::npos, what);
  }
}
