#pragma once
#include <doctest/doctest.h>

#include <algorithm>
#include <cmath>
#include <fstream>
#include <functional>
#include <memory>
#include <sstream>
#include <vector>

#include "app/scenario/parts.h"
#include "core/schema.h"
#include "rig/guard/guard_link.h"
#include "tests/e2e/child.h"
#include "tests/skip.h"
#include "tests/temporary_folder.h"

namespace faba {

inline constexpr double kNeutral = 2.5;  // V

inline constexpr double kWithin = 0.1;  // s after the end or stop of a program, the current must be zero

/// Maximum stall of the machine, s, in a valid attempt. With a larger allowance, a guard that misses one
/// deadline and acts at the next one would still pass.
inline const double kMostLate = CoilGuard::Params{}.heartbeat_deadline;

/// Checks s < within + stall of the machine. Returns false, without a check, if s >= within and the machine
/// stalled for longer than kMostLate.
[[nodiscard]] inline bool checked_in_time(double s, double within, const StallMeter& machine) {
  const double late = machine.longest();
  if (s >= within && late > kMostLate) return false;
  CHECK(s < within + std::min(late, kMostLate));
  return true;
}

/// Repeats the attempt until it returns true: the machine did not stall. The test case is skipped, not
/// passed, if the machine stalled in all attempts.
inline void until_in_time(const std::function<bool()>& attempt) {
  constexpr int kAttempts = 6;
  for (int i = 0; i < kAttempts; ++i) {
    INFO("attempt ", i);
    if (attempt()) return;
  }
  test::skip(std::to_string(kAttempts) + " attempts, and the machine stalled in each");
}

/// A mock of NI-DAQmx for the guards that are started while this object exists. It logs all outputs.
struct NiDevice {
  explicit NiDevice(int fail_at = 0) : folder("ni") {
    setenv("FAKE_NI_LOG", (folder.path() / "log").c_str(), 1);
    setenv("FAKE_NI_FAIL_AT", std::to_string(fail_at).c_str(), 1);
  }
  struct Line {
    double t;
    std::string channel;
    double value;
  };
  std::vector<Line> log() const {
    std::vector<Line> all;
    std::ifstream in(folder.path() / "log");
    for (Line l; in >> l.t >> l.channel >> l.value;) all.push_back(l);
    return all;
  }
  double last(const std::string& channel) const {
    double v = std::nan("");
    for (const Line& l : log())
      if (l.channel == channel) v = l.value;
    return v;
  }
  // Time of the last toggle of the enable line.
  double last_toggle() const {
    double t = 0, level = 0;
    for (const Line& l : log())
      if (l.channel == "Dev1/port0/line0") {
        if (l.value != level) t = l.t;
        level = l.value;
      }
    return t;
  }
  Json driver(bool line = true) const {
    Json j = {{"type", "nidaqmx"}, {"library", FABA_FAKE_NI}};
    if (line) j["enable_line"] = "Dev1/port0/line0";
    return j;
  }
  test::TemporaryFolder folder;
};

/// The firmware on this computer, behind a pseudo-terminal, with a log of its outputs.
struct Firmware {
  Firmware() : folder("firmware") {
    child = std::make_unique<Child>(folder.path(), std::string("'" FABA_FIRMWARE "' port log"));
    REQUIRE(soon([&] { return std::filesystem::is_symlink(folder.path() / "port"); }));
  }
  Json driver() const { return {{"type", "serial"}, {"port", (folder.path() / "port").string()}}; }
  // Time, enable line, and maximum deviation of an output from neutral, V.
  struct Line {
    double t = 0;
    int enable = 0;
    double furthest = 0;
  };
  std::vector<Line> log() const {
    std::vector<Line> all;
    std::ifstream in(folder.path() / "log");
    for (std::string text; std::getline(in, text);) {
      std::stringstream words(text);
      Line l;
      words >> l.t >> l.enable;
      for (double v; words >> v;) l.furthest = std::max(l.furthest, std::fabs(1e-6 * v - kNeutral));
      all.push_back(l);
    }
    return all;
  }
  double rest_after(double t) const {
    REQUIRE(soon([&] { return !log().empty() && log().back().enable == 0; }, 5));
    return log().back().t - t;
  }
  test::TemporaryFolder folder;
  std::unique_ptr<Child> child;
  StallMeter machine;
};

/// A guard for coils of 0.2 A/V about 2.5 V on these channels. `patient`: timeouts of 1 s, for tests that do
/// not test the timeouts: a busy machine may stall for longer than 100 ms.
inline GuardSetup coils_on(const Json& driver, const std::vector<std::string>& channels,
                           const std::vector<std::string>& senses = {}, bool patient = true) {
  GuardSetup s;
  if (patient) s.guard.command_deadline = s.guard.heartbeat_deadline = 1;  // s
  Document d;
  d.root = {{"driver", driver}};
  s.driver = builtin_parts().driver.resolve(Node(d).child("driver"));
  for (std::size_t k = 0; k < channels.size(); ++k) {
    WiredCoil c{.channel = channels[k],
                .gain = 0.2,
                .neutral = kNeutral,
                .sense_gain = 0.2,
                .sense_neutral = kNeutral};
    if (k < senses.size()) c.sense = senses[k];
    s.coils.push_back(c);
  }
  s.frame_period = 1.0 / 30;
  return s;
}

/// Requests currents like a control loop, for `s` seconds.
inline void steer(GuardLink& g, double s, double current = 0.3) {
  for (const double until = monotonic_now() + s; monotonic_now() < until;) {
    g.request(std::vector<double>(g.coils(), current), monotonic_now());
    std::this_thread::sleep_for(std::chrono::milliseconds(10));
  }
}

}  // namespace faba
