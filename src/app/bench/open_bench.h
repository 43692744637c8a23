#pragma once
#include <memory>

#include "app/bench/bench_controls.h"
#include "app/bench/bench_process.h"
#include "rig/bench/bench_rig.h"
#include "rig/bench/device_list.h"

namespace faba {

/// The bench of a scenario, opened: its camera gives pictures and its coils are disarmed. Several runs may
/// follow one another on it.
class OpenBench {
 public:
  /// Begins a simulated bench when the scenario names none. `s.camera.rate` becomes the camera's. Throws
  /// Error(usage) for a scenario that does not fit, before anything is opened where this can be known;
  /// Error(device).
  enum class Open { all, coils };
  OpenBench(Scenario& s, std::uint64_t seed, Open what = Open::all);

  /// Camera and coils as a rig, made when first asked for; the guard's log goes to `log` then, none when
  /// empty. Throws Error(device).
  BenchRig& rig(const std::filesystem::path& log);
  /// Throws Error(device) when the coils' driver cannot be opened, so that nothing need be written then.
  void try_coils() const;
  /// How long this machine takes from mid-exposure of a picture to the command that the scenario's parts
  /// answer it with, s: the median of a few pictures. Coils stay disarmed. 0 where commands move nothing or
  /// the camera waits for them. Throws Error(device).
  double delay(const Scenario& s);
  const std::shared_ptr<Camera>& camera() const { return camera_; }  ///< null when not opened
  /// What a GuardLink needs, for those who want coils and no camera.
  GuardSetup guard_setup(const std::filesystem::path& log) const {
    return setup_.guard_setup(frame_period_, log);
  }

 private:
  std::unique_ptr<BenchProcess> process_;
  RigSetup setup_;
  double frame_period_ = 0;  ///< s
  std::shared_ptr<Camera> camera_;
  std::unique_ptr<BenchRig> rig_;
};

/// What a bench is like, found without letting current flow: pictures for a while, what the guard says, and
/// where the estimator sees a swarm. For `faba rig check`.
Json check_bench(Scenario s, std::uint64_t seed, double seconds);

}  // namespace faba
