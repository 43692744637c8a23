// What the library that stands for NI-DAQmx refuses, and what the guard's process makes of it.
#include "tests/rig/devices.h"

using namespace faba;

TEST_CASE(
    "NI: an error at call k, for every k, ends with a line that is dropped and the device's own words") {
  for (int k = 1; k <= 40; k += k < 12 ? 1 : 7) {
    INFO("call ", k);
    NiDevice ni(k);
    std::string said;
    try {
      GuardLink g(coils_on(ni.driver(), {"Dev1/ao0"}, {"Dev1/ai0"}), FABA_GUARD);
      g.arm();
      steer(g, 0.4);
      said = g.report().reason.data();
      CHECK(g.report().state == CoilGuard::State::faulted);
    } catch (const Error& e) {
      CHECK(e.code() == Errc::device);
      said = e.what();
    }
    CHECK(said.find("-200324") != std::string::npos);
    CHECK(said.find('\n') == std::string::npos);
    const double t = ni.last_toggle();
    std::this_thread::sleep_for(std::chrono::milliseconds(30));
    CHECK(ni.last_toggle() == t);
  }
}

TEST_CASE("NI: what cannot be: no library, no such device, a voltage it does not give") {
  NiDevice ni;
  for (const auto& [driver, channel, said] :
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
    CHECK_MESSAGE(what.find(said) != std::string::npos, what);
  }
}
