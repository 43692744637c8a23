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

inline constexpr double kWithin = 0.1;  // s after whatever ends or stops a program, no current flows

/// A machine that stood still for longer than this, s, proves nothing about a guard: with an allowance as
/// long as the guard's own deadline a guard that misses one deadline and acts at the next one would still
/// pass.
inline const double kMostLate = CoilGuard::Params{}.heartbeat_deadline;

/// Checks that what took `s` was over `within`, or later only by what the machine stood still. False when it
/// was not and the machine stood still for longer than kMostLate: nothing is checked then.
[[nodiscard]] inline bool checked_in_time(double s, double within, const StandStill& machine) {
  const double late = machine.longest();
  if (s >= within && late > kMostLate) return false;
  CHECK(s < within + std::min(late, kMostLate));
  return true;
}

/// Makes attempts until the machine was not late in one, which then returns true. The test case is skipped,
/// not passed, when the machine was late in all of them.
inline void until_in_time(const std::function<bool()>& attempt) {
  constexpr int kAttempts = 6;
  for (int i = 0; i < kAttempts; ++i) {
    INFO("attempt ", i);
    if (attempt()) return;
  }
  test::skip(std::to_string(kAttempts) + " attempts, and the machine was late in each");
}

/// The library that stands for NI-DAQmx, for the guards that are begun while this exists. It keeps a log of
/// all that it is told.
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
  // When the enable line toggled for the last time.
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
  // Whether the enable line is up, and the furthest an output is from neutral, V; when that came to be.
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
  StandStill machine;
};

/// A guard for coils of 0.2 A/V about 2.5 V on these channels. A busy machine may stand still for longer than
/// the deadlines of a tenth of a second, which is not what is tested where it is `patient`.
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

/// Asks for currents as a loop does, for so long.
inline void steer(GuardLink& g, double s, double current = 0.3) {
  for (const double until = monotonic_now() + s; monotonic_now() < until;) {
    g.request(std::vector<double>(g.coils(), current), monotonic_now());
    std::this_thread::sleep_for(std::chrono::milliseconds(10));
  }
}

}  // namespace faba
