#pragma once
#include <doctest/doctest.h>

#include <cmath>
#include <fstream>
#include <sstream>

#include "tests/e2e/program.h"
#include "tests/rig/devices.h"

namespace faba {

inline constexpr double kZero = 5e-3;  // A, 1 % of full scale and four steps of 1.2 mA of a 12-bit output

inline const std::string kScene =
    "duration = '20 s'\nseed = 1\ncamera = { rate = '30 Hz' }\n"
    "limits = { max_current = '0.4 A' }\n"
    "arena = { type = 'box', size_px = [160, 120] }\n"
    "controller = { type = 'manual', current = [0.3, -0.2] }\n"
    "[[swarm]]\ncount = 30\nmodel = { type = 'dipole', preset = 'IT-1' }\n";

inline const std::string kSimulatedCoils = "driver = { type = 'simulated', at = 'bench' }\n";

// Long deadlines for tests of something else, because a busy machine can stall.
inline const std::string kPatient =
    "camera_timeout = '5 s'\nguard = { heartbeat_deadline = '1 s', command_deadline = '1 s' }\n";

// Whether a run ended because the program or a device was too slow. Devices are programs here, and may not
// have noticed yet that the previous run has ended.
inline bool was_late(const std::string& err) {
  for (const char* what :
       {"command timeout", "heartbeat timeout", "stale command", "no answer for", "bench disconnected"})
    if (err.find(what) != std::string::npos) return true;
  return false;
}

inline constexpr double kBusy = 3e-3;  // s, wake-up latency of a busy machine; about 1 ms on an idle machine

struct Flowing {
  double t;     // s, monotonic
  double most;  // maximum over the coils: current, A, or voltage from neutral, V
};

inline std::vector<Flowing> read_coils_log(const std::filesystem::path& csv) {
  std::vector<Flowing> all;
  std::ifstream in(csv);
  std::string line;
  std::getline(in, line);
  const auto columns = std::count(line.begin(), line.end(), ',') + 1;
  const auto coils = (columns - 3) / 2;
  while (std::getline(in, line)) {
    if (in.eof()) break;                                                  // being written
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

// A simulated bench with its log, and a run on it.
struct OnBench {
  explicit OnBench(const std::string& bench = "", const std::string& more = "")
      : f(),
        rig("\n[rig]\ncamera = { type = 'simulated', at = 'bench' }\n" +
            (more.starts_with("driver") ? "" : kSimulatedCoils) + more + "[rig.bench]\n" + bench) {
    test::works_in_real_time();
    write_file(f.path / "scene.toml", kScene + rig);
    simulated = std::make_unique<Child>(
        f.path, "'" FABA_PROGRAM "' rig simulate scene.toml --at bench --log coils.csv --quiet 2> bench.txt");
    REQUIRE(soon([&] { return std::filesystem::exists(f.path / "bench"); }));
  }
  /// Starts the run. See steer().
  void run() {
    program = std::make_unique<Child>(
        f.path, "'" FABA_PROGRAM "' rig run scene.toml --arm --force --quiet --out run 2> err.txt");
  }
  /// Starts the run and returns when current has flowed (`flows`) for 0.2 s. If the machine stalls for 0.1 s,
  /// the guard ends the run, as intended; the run is then started again. After five attempts the test case is
  /// skipped; returns false.
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
  // Seconds from `t` to the last time at which current flowed.
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
  /// Whether the guard ended the run because of a timeout while the machine was busy.
  bool was_kept_waiting() const { return was_late(err()) && machine.longest() > kBusy; }
  std::string err() const { return read_file(f.path / "err.txt"); }

  TestFolder f;
  std::string rig;
  std::unique_ptr<Child> simulated, program;
  StallMeter machine;
};

}  // namespace faba
