#pragma once
#include <doctest/doctest.h>

#include <cmath>
#include <fstream>
#include <sstream>

#include "tests/e2e/program.h"
#include "tests/rig/devices.h"

namespace faba {

inline constexpr double kZero =
    5e-3;  // A, a hundredth of full scale and four of a 12-bit output's steps of 1.2 mA

inline const std::string kScene =
    "duration = '20 s'\nseed = 1\ncamera = { rate = '30 Hz' }\n"
    "limits = { max_current = '0.4 A' }\n"
    "arena = { type = 'box', size_px = [160, 120] }\n"
    "controller = { type = 'manual', current = [0.3, -0.2] }\n"
    "[[swarm]]\ncount = 30\nmodel = { type = 'dipole', preset = 'IT-1' }\n";

inline const std::string kSimulatedCoils = "driver = { type = 'simulated', at = 'bench' }\n";

// Where deadlines are not what is tested: a busy machine may stand still for as long.
inline const std::string kPatient =
    "camera_timeout = '5 s'\nguard = { heartbeat_deadline = '1 s', command_deadline = '1 s' }\n";

// Whether a run was ended because the program was too slow, or a device, which is a program here and may not
// have noticed yet that the run before is over.
inline bool was_late(const std::string& err) {
  for (const char* what :
       {"command timeout", "heartbeat timeout", "stale command", "no answer for", "bench disconnected"})
    if (err.find(what) != std::string::npos) return true;
  return false;
}

inline constexpr double kBusy =
    3e-3;  // s that a thread waits to be woken, which on a quiet machine is a millisecond

struct Flowing {
  double t;     // s, monotonic
  double most;  // A, in any coil, or V beyond the voltage of none
};

inline std::vector<Flowing> read_coils_log(const std::filesystem::path& csv) {
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
  /// Begins it. See steer().
  void run() {
    program = std::make_unique<Child>(
        f.path, "'" FABA_PROGRAM "' rig run scene.toml --arm --force --quiet --out run 2> err.txt");
  }
  /// Begins it, and returns when current has flowed for a while, as `flows` tells. A machine that stands
  /// still for a tenth of a second lets the guard end a run, as it should, whatever the test is of: it is
  /// begun again. False when the machine was late every time: the test case is skipped then.
  [[nodiscard]] bool steer(const std::function<bool()>& flows) {
    for (int attempt = 0; attempt < 5; ++attempt) {
      machine.begin();
      run();
      if (!soon([&] { return program->ended() || flows(); })) break;
      std::this_thread::sleep_for(std::chrono::milliseconds(200));
      if (!program->ended()) return true;
      if (!was_kept_waiting()) break;
      if (attempt == 4) {
        test::skip("the machine was late in five runs: " + err());
        return false;
      }
    }
    FAIL("no current, or not for long: " << err());
    return false;
  }
  [[nodiscard]] bool steer() {
    return steer([this] { return flows(); });
  }
  std::vector<Flowing> log() const { return read_coils_log(f.path / "coils.csv"); }
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
  /// Whether the guard ended the run because something was late, on a machine that kept it waiting.
  bool was_kept_waiting() const { return was_late(err()) && machine.longest() > kBusy; }
  std::string err() const { return read_file(f.path / "err.txt"); }

  TestFolder f;
  std::string rig;
  std::unique_ptr<Child> simulated, program;
  StandStill machine;
};

}  // namespace faba
