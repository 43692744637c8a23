// Errors of the mock of NI-DAQmx, and the reaction of the guard's process.
#include "core/file.h"
#include "rig/bench/device_list.h"
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

TEST_CASE("NI-DAQmx Base: its functions have other names, and an enable line is a bit of a port") {
  NiDevice ni;
  Json driver = ni.driver();
  driver["library"] = FABA_FAKE_NI_BASE;
  {
    GuardLink g(coils_on(driver, {"Dev1/ao0"}, {"Dev1/ai0"}), FABA_GUARD);
    g.arm();
    steer(g, 0.2);
    CHECK(g.report().state == CoilGuard::State::armed);
  }
  bool high = false, driven = false;
  for (const NiDevice::Line& l : ni.log()) {
    if (l.channel == "Dev1/port0/line0") {
      CHECK((l.value == 0 || l.value == 1));
      high = high || l.value == 1;
    } else if (l.channel == "Dev1/ao0") {
      driven = driven || l.value != kNeutral;
    }
  }
  CHECK(high);
  CHECK(driven);
  CHECK(ni.last("Dev1/ao0") == kNeutral);
}

TEST_CASE("the list of devices names a USB-6009 that has no library, and says what drives it") {
  const test::TemporaryFolder sys("sys");
  const auto device = sys.path() / "bus/usb/devices/1-2";
  std::filesystem::create_directories(device);
  write_file(device / "idVendor", "3923\n");
  write_file(device / "product", "USB-6009\n");
  const std::vector<Device> all = device_list("libnone.so", sys.path());
  const auto found =
      std::find_if(all.begin(), all.end(), [](const Device& d) { return d.kind == "USB device"; });
  REQUIRE(found != all.end());
  CHECK(found->what.find("USB-6009") != std::string::npos);
  CHECK(found->what.find("NI-DAQmx Base") != std::string::npos);
}
