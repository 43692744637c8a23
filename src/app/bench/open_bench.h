#pragma once
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "app/bench/bench_controls.h"
#include "app/bench/bench_watcher.h"
#include "rig/bench/bench_rig.h"
#include "rig/bench/device_list.h"

namespace faba {

/// The opened bench of a scenario: its camera gives pictures and its coils are disarmed. It can be used for
/// several runs in succession.
class OpenBench {
 public:
  /// Starts a simulated bench if the scenario has simulated devices without a socket. Sets `s.camera.rate` to
  /// the rate of the camera. Throws Error(usage) for an unsuitable scenario, if possible before a device is
  /// opened; Error(device).
  enum class Open { all, coils };
  OpenBench(Scenario& s, std::uint64_t seed, Open what = Open::all, BenchDevices devices = {});

  /// Camera and coils as a rig, created by the first call with the log of the guard in `log` (empty: no log).
  /// Throws Error(device).
  BenchRig& rig(const std::filesystem::path& log);
  /// Shows the control cycles of rig() to the watcher, if there is one; otherwise null.
  Sink* shown() { return shown_.get(); }
  /// Throws Error(device) if the coil driver cannot be opened; for a check before files are written.
  void try_coils() const;
  /// Latency from mid-exposure of a picture to the command of the scenario's parts on this machine, s: median
  /// of a few pictures. The coils stay disarmed. 0 if the driver drives no current or the camera waits for
  /// commands. Throws Error(device).
  double delay(const Scenario& s);
  const std::shared_ptr<Camera>& camera() const { return camera_; }  ///< null if not opened
  /// Setup of a GuardLink, for use of the coils without the camera.
  GuardSetup guard_setup(const std::filesystem::path& log) const {
    return setup_.guard_setup(frame_period_, log);
  }

 private:
  class Shown;
  BenchDevices devices_;
  RigSetup setup_;
  double frame_period_ = 0;  ///< s
  std::shared_ptr<Camera> camera_;
  std::unique_ptr<BenchRig> rig_;
  std::unique_ptr<Sink> shown_;
};

/// Result of check_bench().
struct BenchCheck {
  std::string camera, driver;  ///< names of the parts
  int width_px = 0, height_px = 0;
  std::optional<double> rate_hz;  ///< of the received frames; empty for a single frame
  std::uint64_t frames = 0, dropped = 0, corrupt = 0;
  double age_s = 0;              ///< of the last frame, from mid-exposure to arrival in the program
  double delay_s = 0;            ///< see OpenBench::delay
  std::string guard;             ///< name of its state
  std::string cannot_arm;        ///< why the coils cannot be armed; empty if they can
  std::vector<double> sensed_a;  ///< current of each coil, A; NaN if it is not measured
  /// Swarm detected by the estimator; otherwise empty.
  struct Swarm {
    double cells = 0;
    Vec2 centroid_px;
  };
  std::optional<Swarm> swarm;
};

/// Checks a bench without current: reads pictures for `seconds`, the state of the guard, and the estimate of
/// the swarm. For `faba rig check`.
BenchCheck check_bench(Scenario s, std::uint64_t seed, double seconds);

}  // namespace faba
